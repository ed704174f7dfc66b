//! Both encodings, shared vertices, and damage.

use super::*;
use crate::formats::{Dropped, Faces, read_bytes};
use glam::Vec3;

/// Corners of the four triangles of a tetrahedron, outwards.
fn tetrahedron() -> Vec<[[f32; 3]; 3]> {
    let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 0.1]];
    [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|face| face.map(|corner: usize| corners[corner])).into()
}

fn binary(header: &str, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        let numbers = [0.0; 3].iter().chain(triangle.as_flattened());
        bytes.extend(numbers.flat_map(|number| number.to_le_bytes()));
        bytes.extend([7, 200]);
    }
    bytes
}

fn text(triangles: &[[[f32; 3]; 3]]) -> String {
    let vertex = |[x, y, z]: &[f32; 3]| format!("   vertex {x} {y}\t{z}\n");
    let facet = |triangle: &[[f32; 3]; 3]| {
        let vertices: String = triangle.iter().map(vertex).collect();
        format!("  facet normal 0 0 0\n  outer loop\n{vertices}  endloop\n  endfacet\n")
    };
    format!("solid of a vertex\n{}endsolid\n", triangles.iter().map(facet).collect::<String>())
}

fn read(bytes: impl AsRef<[u8]>) -> crate::Result<Loaded> {
    read_bytes("a.stl", bytes.as_ref(), &ReadOptions::default())
}

fn cause(bytes: impl AsRef<[u8]>) -> String {
    read(bytes).unwrap_err().to_string()
}

#[test]
fn corners_at_the_same_coordinates_are_one_vertex() {
    let mut triangles = tetrahedron();
    triangles[1][0] = [-0.0, 0.0, -0.0];
    let upper = text(&triangles).to_uppercase();
    let windows = text(&triangles).replace('\n', "\r\n");
    let bytes = [
        binary("made by a program", &triangles),
        binary("solid with\nfacet", &triangles),
        text(&triangles).into(),
        upper.into(),
        windows.into(),
    ];
    for (bytes, encoding) in bytes.iter().zip([true, true, false, false, false]) {
        let Loaded { cloud, report, .. } = read(bytes).unwrap();
        let corners = [Vec3::ZERO, Vec3::new(0.0, 2.0, 0.0), Vec3::X, Vec3::new(0.0, 0.0, 0.1)];
        assert_eq!(cloud.positions, corners);
        assert_eq!(cloud.triangles, [[0, 1, 2], [0, 2, 3], [2, 1, 3], [1, 0, 3]]);
        assert!(cloud.normals.is_none() && cloud.colours.is_none());
        assert_eq!(report.up, Some(DVec3::Z));
        assert_eq!(report.encoding == Encoding::BinaryLittleEndian, encoding);
        assert_eq!((report.points, report.faces), (4, Faces { understood: 4, skipped: 0 }));
        let counts: Vec<_> = report.elements.iter().map(|element| (&*element.name, element.count)).collect();
        assert_eq!(counts, [("vertex", 4), ("facet", 4)]);
    }
}

#[test]
fn text_of_many_pieces_is_read_in_order() {
    // More than a mebibyte, so that facets are parted between pieces.
    let triangle = |i: u32| [[0.0, 0.0, i as f32], [1.0, 0.0, i as f32], [0.0, 1.0, i as f32 + 1.0]];
    let triangles: Vec<_> = (0..20_000).map(triangle).collect();
    let [of_text, of_binary] = [text(&triangles).into_bytes(), binary("", &triangles)];
    assert!(of_text.len() > 2 << 20);
    let [of_text, of_binary] = [of_text, of_binary].map(|bytes| read(bytes).unwrap().cloud);
    assert_eq!(of_text.triangles.len(), 20_000);
    assert_eq!((of_text.positions, of_text.triangles), (of_binary.positions, of_binary.triangles));
}

#[test]
fn several_solids_are_one_cloud_and_digits_are_kept() {
    let one = text(&tetrahedron());
    let far = one.replace("vertex 0", "vertex 4000000.0625");
    let Loaded { cloud, report, .. } = read(one.clone() + &far).unwrap();
    assert_eq!((cloud.len(), cloud.triangles.len(), report.faces.understood), (7, 8, 8));
    let far = read(far.replace("vertex 1", "vertex 4000001")).unwrap().cloud;
    let xs: Vec<f64> = far.positions.iter().map(|p| far.origin.x + f64::from(p.x)).collect();
    assert_eq!(xs, [4_000_000.062_5, 4_000_000.062_5, 4_000_001.0, 4_000_000.062_5]);
}

#[test]
fn triangles_without_three_places_are_skipped() {
    let mut triangles = tetrahedron();
    triangles.push([[0.0; 3], [0.0; 3], [1.0, 0.0, 0.0]]);
    triangles.push([[f32::NAN, 0.0, 0.0], [0.0; 3], [1.0, 0.0, 0.0]]);
    for bytes in [binary("", &triangles), text(&triangles).into_bytes()] {
        let Loaded { cloud, report, .. } = read(bytes).unwrap();
        assert_eq!((cloud.len(), cloud.triangles.len()), (4, 4));
        assert_eq!(report.faces, Faces { understood: 4, skipped: 2 });
        assert_eq!(report.dropped, Dropped { position: 1, ..Dropped::default() });
    }
}

#[test]
fn damage_is_named() {
    let whole = binary("", &tetrahedron());
    let short = cause(&whole[..200]);
    assert!(short.contains("4 triangles take 284 bytes, and it has 200"), "{short}");
    let trailing = read([&whole[..], b"more"].concat()).unwrap();
    assert_eq!((trailing.report.trailing, trailing.cloud.triangles.len()), (4, 4));
    assert!(cause(b"").contains("is empty"));
    assert!(cause([b"\x1f\x8b", &whole[2..200]].concat()).contains("gzip"));
    assert!(cause(binary("", &[])).contains("no points"));

    let whole = text(&tetrahedron());
    let faults = [
        (whole.replace("endsolid", ""), "without `endsolid`"),
        (whole.replacen("  endloop", "   vertex 1 2 3\n  endloop", 1), "4 facets have 13 corners"),
        (whole.replacen("\t0\n", "\n", 1), "line 4: a vertex has x, y and z"),
        (whole.replacen("\t0\n", "\tnought\n", 1), "line 4: `nought` is not a number"),
        (whole.replacen("\t0\n", "\t0 1\n", 1), "line 4: `1` after x, y and z"),
        ("solid\nendsolid\n".into(), "no points"),
    ];
    for (bytes, expected) in faults {
        let cause = cause(bytes);
        assert!(cause.contains(expected), "{cause}");
    }
}
