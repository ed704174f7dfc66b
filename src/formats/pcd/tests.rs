//! Files that Open3D wrote from formulas (tools/format_samples), headers, and damage.

use super::*;
use crate::formats::read_bytes;
use crate::geometry::Colours;
use glam::{DVec3, Vec3};

fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(format!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/{}"), name)).unwrap()
}

fn parsed(text: &str) -> crate::Result<Loaded> {
    read_bytes("a.pcd", text.as_bytes(), &ReadOptions::default())
}

/// A file with these fields, types and rows, all of 4 bytes.
fn ascii(fields: &str, types: &str, rows: &str) -> String {
    let count = rows.lines().count();
    let sizes = "4 ".repeat(types.split(' ').count());
    format!(
        "# .PCD v0.7\nVERSION 0.7\nFIELDS {fields}\nSIZE {sizes}\nTYPE {types}\nWIDTH {count}\nHEIGHT 1\nDATA ascii\n{rows}"
    )
}

#[test]
fn all_encodings_of_open3d_agree() {
    let raw = |i: u64, axis: usize| {
        let (factor, modulus) = [(7919, 20011), (104_729, 30011), (1_299_709, 9973)][axis];
        ((i * factor % modulus) as f64 - (modulus / 2) as f64) / 1024.0
    };
    for (name, encoding, digits) in [
        ("ascii.pcd", Encoding::Ascii, 1e-8),
        ("binary.pcd", Encoding::BinaryLittleEndian, 0.0),
        ("compressed.pcd", Encoding::Compressed, 0.0),
    ] {
        let Loaded { cloud, report, .. } = read_bytes(name, &bytes(name), &ReadOptions::default()).unwrap();
        assert_eq!((report.encoding, report.points, cloud.len()), (encoding, 60, 60));
        for (i, position) in (0..).zip(&cloud.positions) {
            let exact = DVec3::new(raw(i, 0), raw(i, 1), raw(i, 2));
            let far = (cloud.origin + position.as_dvec3() - exact).abs().max_element();
            // Open3D writes ten digits as text.
            assert!(far <= digits, "{name} {i}: {far}");
        }
        let normals = cloud.normals.unwrap();
        assert!(normals.iter().enumerate().all(|(i, n)| *n == Vec3::AXES[i % 3]), "{name}");
        let Some(Colours::Srgb8(colours)) = cloud.colours else { panic!("{name}: {:?}", cloud.colours) };
        let codes = |i: u64| [i * 4, 255 - i, i * 7 % 256, 0].map(|code| code as u8);
        assert!((0..).zip(&colours).all(|(i, code)| *code == codes(i)), "{name}");
    }
}

#[test]
fn packed_colours_of_text_are_floats_or_integers() {
    let float = f32::from_bits(0x0001_80ff);
    for (kind, value) in [("F", format!("{float:e}")), ("U", 0x0001_80ff.to_string())] {
        let Loaded { cloud, .. } =
            parsed(&ascii("x y z rgb", &format!("F F F {kind}"), &format!("1 2 3 {value}"))).unwrap();
        assert_eq!(cloud.colours, Some(Colours::Srgb8(vec![[1, 0x80, 0xff, 0]])), "{kind}");
    }
}

#[test]
fn fields_of_several_values_and_padding_keep_their_places() {
    let header = "VERSION 0.7\nFIELDS _ x y z h i\nSIZE 1 4 4 4 2 8\nTYPE U F F F U I\nCOUNT 3 1 1 1 2 1\nWIDTH 2\nHEIGHT 1\nPOINTS 2\nDATA binary\n";
    let mut bytes = header.as_bytes().to_vec();
    for point in 0..2u8 {
        bytes.extend([9; 3]);
        [1.0f32, 2.0, 3.0].iter().for_each(|axis| bytes.extend((axis + f32::from(point)).to_le_bytes()));
        [500u16, 600].iter().for_each(|value| bytes.extend((value + u16::from(point)).to_le_bytes()));
        bytes.extend((-7i64).to_le_bytes());
    }
    for (name, expected) in [("h_0", [500.0, 501.0]), ("h_1", [600.0, 601.0]), ("i", [-7.0; 2])] {
        let options = ReadOptions { scalar: Some(name.into()), ..Default::default() };
        let Loaded { cloud, .. } = read_bytes("a", &bytes, &options).unwrap();
        let at = |i: usize| cloud.origin + cloud.positions[i].as_dvec3();
        assert_eq!([at(0), at(1)], [DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 3.0, 4.0)]);
        assert_eq!(cloud.scalar.as_deref(), Some(&expected[..]), "{name}");
    }
}

#[test]
fn a_viewpoint_is_the_scanner_and_missing_points_are_counted() {
    let rows = "1 2 3\nnan nan nan\n4 5 6";
    let unknown = parsed(&ascii("x y z", "F F F", rows)).unwrap();
    assert_eq!((unknown.report.dropped.position, unknown.cloud.view), (1, View::Unknown));
    let seen = ascii("x y z", "F F F", rows).replace("DATA", "VIEWPOINT 1 0 2 1 0 0 0\nDATA");
    assert_eq!(parsed(&seen).unwrap().cloud.view, View::From(Vec3::new(1.0, 0.0, 2.0)));
    assert_eq!(parsed(&seen.replace("POINT 1", "POINT 1e300")).unwrap().cloud.view, View::Unknown);
}

#[test]
fn damage_is_named() {
    let has = |text: &str, what: &str| {
        let cause = parsed(text).unwrap_err().to_string();
        assert!(cause.contains(what), "{cause}: expected {what}");
    };
    let good = ascii("x y z", "F F F", "1 2 3\n4 5 6");
    has(&good.replace("WIDTH 2", "WIDTH 3"), "claims 3 points, but 2 lines follow");
    has(&good.replace("4 5 6", "4 5"), "line 10: 2 values");
    has(&good.replace("4 5 6", "4 5 a"), "line 10: `a` is not a number");
    has(&good.replace("WIDTH 2\n", ""), "neither POINTS nor WIDTH and HEIGHT");
    has(&good.replace("WIDTH 2", "WIDTH two"), "header line 6: `two` is no whole number");
    has(&good.replace("ascii", "binary"), "2 points of 12 bytes, but 11 bytes are left");
    has(&good.replace("ascii", "zipped"), "data are `zipped`");
    has(&good.replace("TYPE F F F", "TYPE F F"), "differ in length");
    has(&good.replace("TYPE F F F", "TYPE F F I").replace("4 4 4 ", "4 4 3 "), "type `I` and size `3`");
    has(&good.replace("FIELDS x", "FIELDS a"), "no x y z");
    has(&good.replace("HEIGHT", "DEPTH"), "`DEPTH` is no keyword");
    has(&good[..good.find("DATA").unwrap()], "no line DATA");
    let compressed = bytes("compressed.pcd");
    let failure = |bytes: &[u8]| read_bytes("a", bytes, &ReadOptions::default()).unwrap_err().to_string();
    assert!(failure(&compressed[..compressed.len() - 9]).contains("ends within its compressed points"));
    let payload = compressed.windows(11).position(|line| line == b"compressed\n").unwrap() + 11;
    let mut damaged = compressed.clone();
    damaged[payload + 8..payload + 40].fill(0xff);
    assert!(failure(&damaged).contains("compressed points are damaged"));
    let mut claims = compressed;
    claims[payload + 4..payload + 8].copy_from_slice(&7u32.to_le_bytes());
    assert!(failure(&claims).contains("60 points of 28 bytes, but 7 bytes are left"));
    claims[payload + 4..payload + 8].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(failure(&claims).contains("hold 4294967295"), "{}", failure(&claims));
}
