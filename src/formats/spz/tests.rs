//! Gaussians from bytes, and damage.

use super::*;
use crate::formats::read_bytes;
use crate::geometry::Colours;
use flate2::Compression;
use flate2::write::GzEncoder;
use glam::Vec3;
use std::io::Write;

/// Two Gaussians: at (1, −2, 0.5) and (−1, 0, 0), the second one faint. Bytes of a version's rotations follow.
fn arrays(version: u32, degree: usize, rotations: &[u8]) -> Vec<u8> {
    // 24 bits of which 12 are behind the point, or half precision.
    let fixed: [u8; 18] = [0, 16, 0, 0, 0xe0, 0xff, 0, 8, 0, 0, 0xf0, 0xff, 0, 0, 0, 0, 0, 0];
    let halves: [u8; 12] = [0, 0x3c, 0, 0xc0, 0, 0x38, 0, 0xbc, 0, 0, 0, 0];
    let positions: &[u8] = if version == 1 { &halves } else { &fixed };
    let alphas = [255, 20];
    let colours = [128, 255, 0, 1, 2, 3];
    // exp(0), exp(−2), exp(−5).
    let scales = [160, 128, 80, 160, 160, 160];
    let harmonics = vec![7; 2 * 3 * [0, 3, 8, 15, 24][degree]];
    [positions, &alphas, &colours, &scales, rotations, &harmonics].concat()
}

fn header(version: u32, count: u32, degree: u8, flags: u8) -> Vec<u8> {
    [b"NGSP".as_slice(), &version.to_le_bytes(), &count.to_le_bytes(), &[degree, 12, flags, 0]].concat()
}

fn packed(parts: &[&[u8]]) -> Vec<u8> {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    parts.iter().for_each(|part| encoder.write_all(part).unwrap());
    encoder.finish().unwrap()
}

/// Quarter turns about x, y to z, in the encoding of version 3.
const TURNED: [u8; 8] = [0, 0, 0xf0, 0xdf, 0, 0, 0xf0, 0xdf];
/// The same in that of the versions before.
const TURNED_BEFORE: [u8; 6] = [218, 128, 128, 218, 128, 128];

fn read(bytes: &[u8]) -> crate::Result<Loaded> {
    read_bytes("a", bytes, &ReadOptions::default())
}

#[test]
fn all_versions_become_discs() {
    for (version, rotations) in [(1, &TURNED_BEFORE[..]), (2, &TURNED_BEFORE), (3, &TURNED)] {
        for degree in 0..5 {
            let head = header(version, 2, degree as u8, 1);
            let Loaded { cloud, report, .. } =
                read(&packed(&[&head, &arrays(version, degree, rotations)])).unwrap();
            assert_eq!((report.points, report.dropped.transparent), (2, 1), "version {version}");
            assert!(report.gaussians && report.up == Some(DVec3::Y));
            assert_eq!(cloud.origin + cloud.positions[0].as_dvec3(), DVec3::new(1.0, -2.0, 0.5));
            // Half of the range of the harmonics is (code / 255 − 0.5) / 0.15 · 0.282: beyond white and black.
            assert_eq!(cloud.colours, Some(Colours::Srgb8(vec![[128, 255, 0, 0]])));
            let (normals, radii, ellipses) =
                (cloud.normals.unwrap(), cloud.radii.unwrap(), cloud.ellipses.unwrap());
            assert!(normals[0].abs_diff_eq(-Vec3::Y, 2e-2) && (radii[0] - 2.0).abs() < 1e-6, "{normals:?}");
            assert!((ellipses[0].aspect - (-2f32).exp()).abs() < 1e-6, "{ellipses:?}");
        }
    }
}

#[test]
fn data_of_extensions_are_skipped() {
    let file = |flags: u8| packed(&[&header(3, 2, 0, flags), &arrays(3, 0, &TURNED), b"extension"]);
    assert_eq!(read(&file(2)).unwrap().cloud.len(), 1);
    assert!(read(&file(0)).unwrap_err().to_string().contains("more than its header states"));
}

#[test]
fn spz_is_distinguished_from_other_gzip_files() {
    assert!(header::is_spz(&packed(&[&header(3, 2, 0, 0)])) && header::is_spz(&header(4, 2, 0, 0)));
    assert!(
        !header::is_spz(&packed(&[b"ply\n"])) && !header::is_spz(b"\x1f\x8b\x08") && !header::is_spz(b"")
    );
    let other = read_bytes("a.spz", &packed(&[b"ply\n"]), &ReadOptions::default()).unwrap_err().to_string();
    assert!(other.contains("gzip-compressed"), "{other}");
}

#[test]
fn faults_are_named() {
    let (head, body) = (header(3, 2, 0, 0), arrays(3, 0, &TURNED));
    let whole = packed(&[&head, &body]);
    let mut wrong = whole.clone();
    let end = wrong.len() - 6;
    wrong[end] ^= 1;
    let cases = [
        (whole[..whole.len() - 9].to_vec(), "ends within its compressed points"),
        (whole[..whole.len() - 1].to_vec(), "ends within its compressed points"),
        (wrong, "compressed points are damaged"),
        (packed(&[&head[..12]]), "ends within its compressed points"),
        (packed(&[&head, &body[..body.len() - 1]]), "ends within its compressed points"),
        (packed(&[&header(3, 2, 3, 0), &body]), "ends within its compressed points"),
        (packed(&[&header(9, 2, 0, 0), &body]), "SPZ version 9 is not supported, only 1 to 3"),
        (header(4, 2, 0, 0), "SPZ version 4 is not supported"),
        (packed(&[&header(3, 2, 5, 0), &body]), "the degree 5"),
        (packed(&[&header(3, u32::MAX, 0, 0), &body]), "claims 4294967295 points in 85899345900 bytes"),
        (packed(&[&header(3, 0, 0, 0)]), "it has no points"),
    ];
    for (bytes, expected) in cases {
        let cause = read(&bytes).unwrap_err().to_string();
        assert!(cause.contains(expected), "{expected}: {cause}");
    }
}

#[test]
fn a_bomb_is_not_unpacked() {
    // Many megabytes of zeros, of which the header states two Gaussians.
    let zeros = vec![0; 1 << 20];
    let mut parts = vec![&zeros[..]; 64];
    let (head, body) = (header(3, 2, 0, 0), arrays(3, 0, &TURNED));
    parts.splice(0..0, [&head[..], &body]);
    let bomb = packed(&parts);
    assert!(bomb.len() < 200_000);
    assert!(read(&bomb).unwrap_err().to_string().contains("more than its header states"));
}
