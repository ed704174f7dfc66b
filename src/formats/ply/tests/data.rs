//! Files of the shared test data.

use super::*;
use crate::geometry::View;
use crate::skipping::data;

fn open(path: &Path) -> Loaded {
    read(path, &ReadOptions::default(), &()).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn classic_point_clouds_load_whole() {
    let Some(folder) = data("classic") else { return };
    for (name, count) in [("bunny16k.ply", 16130), ("chameleon4k.ply", 4594)] {
        let Loaded { cloud, report, .. } = open(&folder.join(name));
        assert_eq!((cloud.len(), report.dropped.total()), (count, 0), "{name}");
        assert!(cloud.normals.unwrap().iter().all(|n| (n.length() - 1.0).abs() < 1e-6), "{name}");
        assert_eq!(
            (cloud.radii.unwrap().len(), cloud.colours.map(|colours| colours.len())),
            (count, Some(count))
        );
        assert_eq!((report.skipped, cloud.origin), (vec!["alpha".to_owned()], DVec3::ZERO));
    }
}

/// How many of the triangles face along `direction` from their first corner, in parts of all.
fn facing(cloud: &Cloud, direction: impl Fn(Vec3) -> Vec3) -> f64 {
    let faces = |triangle: &&[u32; 3]| {
        let [a, b, c] = triangle.map(|corner| cloud.positions[corner as usize]);
        (b - a).cross(c - a).dot(direction(a)) > 0.0
    };
    cloud.triangles.iter().filter(faces).count() as f64 / cloud.triangles.len() as f64
}

#[test]
fn the_camera_stands_where_the_faces_look() {
    let Some(folder) = data("scans") else { return };
    let Loaded { cloud, report, .. } = open(&folder.join("laurana_rangemap_lato180.ply"));
    assert_eq!((cloud.len(), report.faces.understood), (44716, 84635));
    let View::From(eye) = cloud.view else { panic!("{:?}", cloud.view) };
    let facing = facing(&cloud, |corner| eye - corner);
    assert!(facing > 0.999, "{facing} of the faces face the camera");
}

#[test]
fn range_grids_become_triangles() {
    let Some(folder) = data("stanford/bunny/range") else { return };
    let Loaded { cloud, report, .. } = open(&folder.join("bun000.ply"));
    assert_eq!((cloud.len(), cloud.view), (40256, View::Towards(Vec3::Z)));
    // Of a dense height field, two triangles a point, less its rims and tears.
    let a_point = cloud.triangles.len() as f64 / cloud.len() as f64;
    assert!((1.9..2.0).contains(&a_point), "{a_point}");
    assert_eq!(report.faces.understood, cloud.triangles.len() as u64);
    // The scanner's samples are half a millimetre apart.
    let longest = cloud.triangles.iter().map(|triangle| {
        let [a, b, c] = triangle.map(|corner| cloud.positions[corner as usize]);
        a.distance(b).max(b.distance(c)).max(c.distance(a))
    });
    assert!(longest.fold(0.0, f32::max) < 0.005);
    assert_eq!(facing(&cloud, |_| Vec3::Z), 1.0);
}

#[test]
fn strips_become_the_triangles_of_a_closed_surface() {
    let Some(folder) = data("classic") else { return };
    let Loaded { cloud, report, .. } = open(&folder.join("igea.ply"));
    assert_eq!((cloud.len(), report.faces.skipped), (134_345, 0));
    // Each edge runs once each way where the winding is right everywhere.
    let mut edges: Vec<[u32; 2]> =
        cloud.triangles.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]).collect();
    let count = edges.len();
    edges.sort_unstable();
    edges.dedup();
    assert_eq!(edges.len(), count, "no edge runs twice the same way");
    let closed = edges.iter().filter(|&&[a, b]| edges.binary_search(&[b, a]).is_ok()).count();
    assert!(closed as f64 > 0.999 * count as f64, "{closed} of {count}");
}

#[test]
fn gaussians_become_two_sided_discs() {
    let Some(folder) = data("splats") else { return };
    let Loaded { cloud, report, .. } = open(&folder.join("train-1000.ply"));
    assert!(report.gaussians);
    assert_eq!(cloud.len() as u64 + report.dropped.transparent, 1000);
    assert_eq!((report.points, cloud.two_sided), (1000, Some(vec![true; cloud.positions.len()])));
    assert!(cloud.normals.unwrap().iter().all(|n| n.is_normalized()));
    assert!(cloud.radii.unwrap().iter().all(|radius| *radius > 0.0));
    assert!(cloud.ellipses.unwrap().iter().all(|ellipse| ellipse.aspect > 0.0 && ellipse.aspect <= 1.0));
    assert!(matches!(cloud.colours, Some(Colours::Srgb8(_))));
    println!("{:?}", report.dropped);
}

#[test]
fn georeferenced_coordinates_keep_their_millimetres() {
    let Some(folder) = data("scans") else { return };
    let cloud = open(&folder.join("autzen_trim_double.ply")).cloud;
    assert!(cloud.origin.length() > 1e6, "{}", cloud.origin);
    assert!(cloud.positions.iter().all(|position| position.abs().max_element() < 1600.0));
}
