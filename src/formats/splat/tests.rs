//! Gaussians from bytes, the same as in PLY, and damage.

use super::*;
use crate::formats::read_bytes;
use crate::geometry::Colours;
use glam::{DVec3, Vec3};

/// A Gaussian.
fn gaussian(position: [f32; 3], scales: [f32; 3], colour: [u8; 4], rotation: [u8; 4]) -> Vec<u8> {
    let floats = position.into_iter().chain(scales).flat_map(f32::to_le_bytes);
    floats.chain(colour).chain(rotation).collect()
}

fn read(bytes: &[u8]) -> crate::Result<Loaded> {
    read_bytes("a.splat", bytes, &ReadOptions::default())
}

#[test]
fn a_gaussian_becomes_a_disc_across_its_smallest_axis() {
    // A quarter turn about x takes y to z.
    let quarter = [128 + 90, 128 + 90, 128, 128];
    let bytes = [
        gaussian([1.0, 2.0, 3.0], [0.5, 2.0, 0.25], [200, 100, 50, 255], quarter),
        gaussian([0.0; 3], [1.0; 3], [1, 2, 3, 25], [255, 128, 128, 128]),
        gaussian([f32::NAN, 0.0, 0.0], [1.0; 3], [1, 2, 3, 255], [255, 128, 128, 128]),
        gaussian([4.0, 5.0, 6.0], [3.0, 1.0, 0.0], [0, 0, 0, 26], [255, 128, 128, 128]),
    ]
    .concat();
    let Loaded { cloud, report, .. } = read(&bytes).unwrap();
    assert_eq!((report.points, report.dropped.transparent, report.dropped.position), (4, 1, 1));
    assert!(report.gaussians && report.up == Some(DVec3::NEG_Y));
    assert_eq!(cloud.positions, [Vec3::new(1.0, 2.0, 3.0), Vec3::new(4.0, 5.0, 6.0)]);
    assert_eq!(cloud.colours, Some(Colours::Srgb8(vec![[200, 100, 50, 0], [0, 0, 0, 0]])));
    let (normals, radii, ellipses) = (cloud.normals.unwrap(), cloud.radii.unwrap(), cloud.ellipses.unwrap());
    // z of the Gaussian is −y of the scene.
    assert!(normals[0].abs_diff_eq(-Vec3::Y, 1e-6) && ellipses[0].major.z.abs() > 0.999_999, "{normals:?}");
    assert!((radii[0] - 4.0).abs() < 1e-5 && (ellipses[0].aspect - 0.25).abs() < 1e-6, "{radii:?}");
    // One without a thickness is flat already.
    assert!(normals[1].abs_diff_eq(Vec3::Z, 1e-6) && (radii[1] - 6.0).abs() < 1e-5);
    assert_eq!(cloud.two_sided, Some(vec![true; 2]));
}

#[test]
fn gaussians_without_a_rotation_or_size_have_no_disc() {
    let whole = gaussian([1.0; 3], [1.0; 3], [0, 0, 0, 255], [255, 128, 128, 128]);
    let none = [
        gaussian([0.0; 3], [1.0; 3], [0, 0, 0, 255], [128; 4]),
        gaussian([0.0; 3], [0.0; 3], [0, 0, 0, 255], [255, 128, 128, 128]),
        gaussian([0.0; 3], [f32::NAN, -1.0, 1.0], [0, 0, 0, 255], [255, 128, 128, 128]),
    ];
    for bytes in none {
        let cloud = read(&[whole.clone(), bytes].concat()).unwrap().cloud;
        let radii = cloud.radii.unwrap();
        assert!(radii[0] == 2.0 && radii[1] == 0.0, "{radii:?}");
    }
}

#[test]
fn faults_are_named() {
    let one = gaussian([0.0; 3], [1.0; 3], [0, 0, 0, 255], [255, 128, 128, 128]);
    let faint = gaussian([0.0; 3], [1.0; 3], [0, 0, 0, 0], [255, 128, 128, 128]);
    let cases: [(&[u8], &str); 4] = [
        (&[], "is empty"),
        (&one[..31], "31 bytes are no multiple of 32"),
        (&[&one[..], b"\n"].concat(), "33 bytes are no multiple of 32"),
        (&faint, "1 are less than a tenth opaque"),
    ];
    for (bytes, expected) in cases {
        let cause = read(bytes).unwrap_err().to_string();
        assert!(cause.contains(expected), "{cause}");
    }
}
