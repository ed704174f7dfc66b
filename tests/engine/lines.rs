//! The apple tree of the paper's kind as lines (marroquim2008, section 4.3).

use crate::support::skipping::data;
use surfel::estimate::Estimate;
use surfel::formats::{self, ReadOptions};
use surfel::geometry::{Colours, Lined, Model, ToLines};

#[test]
fn an_apple_tree_becomes_ribbons_tubes_and_a_trunk() {
    let Some(path) = data("plants/appletree.ply") else { return };
    let options = ReadOptions { triangles: true, ..Default::default() };
    let tree = formats::read(&path, &options, &()).unwrap().cloud;
    let (cloud, lined) = tree.to_lines(&ToLines::default()).unwrap();
    println!("{lined:?}");
    // 2590 leaves of six triangles, of which two lie on others; and three segments each.
    let Lined { triangles, leaves, branches, vertices, .. } = lined;
    assert_eq!(leaves, [6 * 2588, 3 * 2588]);
    // Rings of five corners: ten triangles a segment.
    assert_eq!(branches[0], 10 * branches[1]);
    let stay = triangles - leaves[0] - branches[0];
    assert!(stay * 20 < triangles && vertices[1] * 4 < vertices[0], "{lined:?}");
    let (Model { surfels, primitives }, _) = cloud.into_model(true, &Estimate::default(), &()).unwrap();
    assert_eq!((surfels.len(), primitives.triangles.len() as u64), (0, stay));
    assert_eq!((primitives.count_invalid(), primitives.check().is_ok()), (0, true));
    // Leaves are green, branches brown, all of them.
    let Some(Colours::Srgb8(codes)) = &primitives.colours else { panic!("no codes") };
    let all = |lines: &[[u32; 2]], code| lines.iter().flatten().all(|&i| codes[i as usize] == code);
    assert!(all(&primitives.ribbons, [0, 181, 0, 0]) && all(&primitives.tubes, [42, 42, 17, 0]));
    let bounds = |model: &Model| surfel::geometry::Parts::from(model).bounds().unwrap();
    let (mesh, _) = tree.into_model(true, &Estimate::default(), &()).unwrap();
    let lines = bounds(&Model { surfels, primitives });
    let mesh = bounds(&mesh);
    let off = (lines.min - mesh.min).abs().max((lines.max - mesh.max).abs()).max_element();
    assert!(off < 0.02 * mesh.radius, "{lines:?} {mesh:?}");
}
