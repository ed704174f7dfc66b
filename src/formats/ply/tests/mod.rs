//! Whole files in memory.

mod data;
mod features;
mod lines;
mod nonsense;
mod written;

use super::*;
use crate::error::Error;
use crate::formats::{Dropped, Faces, Lines, read, read_bytes};
use crate::geometry::{Cloud, Colours, Materials};
use cpu_time::ThreadTime;
use glam::{DVec3, Vec3};
use std::time::Duration;

const FLOATS: &str = "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
                      property float nz\nproperty float radius\n";

/// A file of text; its header is `lines` between the first and the last line.
fn text(lines: &str, records: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\n{lines}\nend_header\n{records}").into_bytes()
}

const XYZ: &str = "property float x\nproperty float y\nproperty float z";

fn ascii(count: usize, more: &str, records: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\nelement vertex {count}\n{FLOATS}{more}end_header\n{records}").into_bytes()
}

fn load(bytes: &[u8]) -> Loaded {
    read_bytes("test.ply", bytes, &ReadOptions::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn cause(bytes: &[u8]) -> String {
    read_bytes("test.ply", bytes, &ReadOptions::default()).unwrap_err().to_string()
}

/// Two vertices, after an element of lists and before one; a list and a number that is not supported are among the numbers.
fn mixed(format: &str) -> Vec<u8> {
    let header = format!(
        "ply\nformat {format} 1.0\nelement face 2\nproperty list uchar int vertex_indices\nproperty short tag\n\
         element vertex 2\nproperty double x\nproperty list ushort double rays\nproperty int y\nproperty uchar z\nproperty char nx\n\
         property short ny\nproperty float nz\nproperty float radius\nproperty uint id\nproperty ushort red\nproperty ushort green\n\
         property ushort blue\nelement edge 2\nproperty int a\nend_header\n"
    );
    let values: &[(&str, f64)] = &[
        ("u1", 3.0),
        ("i4", 0.0),
        ("i4", 1.0),
        ("i4", 2.0),
        ("i2", -1.0),
        ("u1", 0.0),
        ("i2", -2.0),
        ("f8", 10.0),
        ("u2", 2.0),
        ("f8", 0.5),
        ("f8", 1.5),
        ("i4", -3.0),
        ("u1", 200.0),
        ("i1", -2.0),
        ("i2", 0.0),
        ("f4", 0.0),
        ("f4", 0.25),
        ("u4", 7.0),
        ("u2", 0.0),
        ("u2", 65535.0),
        ("u2", 30000.0),
        ("f8", -100.5),
        ("u2", 0.0),
        ("i4", 4.0),
        ("u1", 3.0),
        ("i1", 0.0),
        ("i2", 300.0),
        ("f4", 400.0),
        ("f4", 0.5),
        ("u4", 8.0),
        ("u2", 1.0),
        ("u2", 2.0),
        ("u2", 3.0),
        ("i4", 12.0),
        ("i4", 5.0),
    ];
    let mut bytes = header.into_bytes();
    for &(kind, value) in values {
        let mut number = match kind {
            "u1" => vec![value as u8],
            "i1" => vec![value as i8 as u8],
            "i2" => (value as i16).to_le_bytes().to_vec(),
            "u2" => (value as u16).to_le_bytes().to_vec(),
            "i4" => (value as i32).to_le_bytes().to_vec(),
            "u4" => (value as u32).to_le_bytes().to_vec(),
            "f4" => (value as f32).to_le_bytes().to_vec(),
            _ => value.to_le_bytes().to_vec(),
        };
        match format {
            "ascii" => number = format!("{value}\n").into_bytes(),
            "binary_big_endian" => number.reverse(),
            _ => {}
        }
        bytes.extend(number);
    }
    bytes
}

#[test]
fn every_encoding_gives_the_same_surfels() {
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let Loaded { cloud, report, .. } = load(&mixed(format));
        assert_eq!(report.encoding.to_string(), format);
        assert_eq!(cloud.positions, [Vec3::new(10.0, -3.0, 200.0), Vec3::new(-100.5, 4.0, 3.0)], "{format}");
        assert_eq!(cloud.normals, Some(vec![-Vec3::X, Vec3::new(0.0, 0.6, 0.8)]), "{format}");
        assert_eq!(cloud.radii, Some(vec![0.25, 0.5]));
        let Some(Colours::Linear(colours)) = &cloud.colours else { panic!("{format}: no linear colours") };
        assert_eq!((colours[0][0], colours[0][1]), (0.0, 1.0));
        assert!((colours[0][2] - 0.177_015).abs() < 1e-5, "{colours:?}");
        assert_eq!((report.skipped_elements, report.trailing), (vec!["edge".to_owned()], 0));
        assert_eq!(report.skipped, ["rays", "id"]);
        assert_eq!(report.understood, ["x", "y", "z", "nx", "ny", "nz", "radius", "red", "green", "blue"]);
        assert_eq!(report.elements.iter().map(|e| e.count).collect::<Vec<_>>(), [2, 2, 2]);
    }
}

#[test]
fn truncated_anywhere_is_an_error_and_never_a_panic() {
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        let whole = mixed(format);
        let last_needed = whole.len() - if format == "ascii" { 2 } else { 1 };
        for length in 0..=last_needed {
            let text = cause(&whole[..length]);
            assert!(
                text.starts_with("test.ply: ") && text.lines().count() == 1,
                "{format}, {length}: {text}"
            );
        }
    }
}

#[test]
fn text_records_need_no_lines_of_their_own() {
    let plain = load(&ascii(2, "", "1 2 3 0 0 1 .5\n3 2 1 1 0 0 1E-3\n"));
    for records in [
        "1 2 3 0\n0 1 .5 3\t2\r\n1 1 0\n\n 0 1E-3",
        "\n1 2 3 0 0 1 .5\ncomment 9 9 9\n3 2 1 1 0 0 1E-3",
        "1 2 3 0 0 1 .5\r3 2 1 1 0 0 1E-3 ",
    ] {
        assert_eq!(load(&ascii(2, "", records)), plain, "{records:?}");
    }
    assert!(
        cause(&ascii(1, "", "1 2 x 0 0 1 1"))
            .contains("record 0 of element `vertex`, `z`: `x` is not a number")
    );
    assert!(cause(&ascii(2, "", "1.5 2.5 3.5 0 0 1 1 1 2 3 0 0 1")).contains("`radius`: the file ends here"));
}

#[test]
fn rows_of_another_table_differ_from_damage() {
    let text = cause(&ascii(3, "", "1 2 3 0 0 1 .5 9\n\n3 2 1 1 0 0 .5 9\n3 2 2 1 0 0 .5 9\n"));
    assert!(text.contains("have 8 values") && text.contains("declares 7 properties"), "{text}");
    assert!(!text.contains("damaged"), "{text}");
}

#[test]
fn what_has_no_position_is_dropped_and_what_is_missing_is_0() {
    let records = "nan 0 0 0 0 1 1\n0 inf 0 0 0 0 0\n1e39 0 0 0 0 1 1\n0 0 0 0 0 1 0\n0 0 0 0 0 1 -1\n0 0 0 0 0 1 1e-60\n\
                   0 0 0 0 0 1 nan\n0 0 0 0 0 0 1\n0 0 0 0 nan 1 1\n0 0 0 1e-300 0 0 1\n0 0 0 0 -1e300 0 2\n";
    let Loaded { cloud, report, .. } = load(&ascii(11, "", records));
    assert_eq!(report.dropped, Dropped { position: 3, ..Default::default() });
    assert_eq!((report.points, report.dropped.total()), (11, 3));
    let (z, none) = (Vec3::Z, Vec3::ZERO);
    assert_eq!(cloud.normals, Some(vec![z, z, z, z, none, none, Vec3::X, -Vec3::Y]));
    assert_eq!(cloud.radii, Some(vec![0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 2.0]));
    let bare = load(&ascii(1, "", "0 0 0 0 0 0 -1")).cloud;
    assert_eq!((bare.normals, bare.radii), (None, None));
    assert!(cause(&ascii(1, "", "nan 0 0 0 0 1 1")).contains("none of its 1 points has a finite position"));
    assert!(cause(&ascii(0, "", "")).contains("no points"));
}

#[test]
fn colours_come_in_three_kinds() {
    let colours = |kind: &str, values: &str| {
        let more: String = ["red", "green", "blue"].map(|name| format!("property {kind} {name}\n")).concat();
        load(&ascii(1, &more, &format!("0 0 0 0 0 1 1 {values}"))).cloud.colours
    };
    assert_eq!(colours("uchar", "0 128 255"), Some(Colours::Srgb8(vec![[0, 128, 255, 0]])));
    assert_eq!(colours("float", "0 0.5 2"), Some(Colours::Linear(vec![[0.0, 0.5, 2.0]])));
    assert_eq!(colours("double", "-1 nan inf"), Some(Colours::Linear(vec![[0.0; 3]])));
    assert_eq!(colours("ushort", "0 0 65535"), Some(Colours::Linear(vec![[0.0, 0.0, 1.0]])));
    assert_eq!(colours("int", "0 0 255"), None);
}

#[test]
fn large_coordinates_keep_their_fractions() {
    let header = FLOATS.replace("float x", "double x").replace("float y", "double y");
    let mut bytes =
        format!("ply\nformat binary_little_endian 1.0\nelement vertex 2\n{header}end_header\n").into_bytes();
    for x in [10_000_000.125_f64, 10_000_001.000_000_5] {
        bytes.extend([x.to_le_bytes(), (-2.0 * x).to_le_bytes()].concat());
        [0.0_f32, 0.0, 0.0, 1.0, 0.01].iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    }
    let surfels = load(&bytes).cloud;
    let across = surfels.positions[0] - surfels.positions[1];
    assert!((f64::from(across.x.abs()) - 0.875_000_5).abs() < 1e-7, "{across}");
    // The extent is 1.75: the origin is an even number next to the middle.
    assert_eq!(surfels.origin, DVec3::new(10_000_000.0, -20_000_002.0, 0.0));
    let text = load(&ascii(2, "", "1e7 0 0 0 0 1 1 10000000.875 0 0 0 0 1 1")).cloud;
    assert_eq!(text.positions[1].x - text.positions[0].x, 0.875, "text keeps its digits");
    // Ordinary coordinates stay as they are.
    assert_eq!(load(&ascii(2, "", "0.1 0 0 0 0 1 1 1 0 0 0 0 1 1")).cloud.origin, DVec3::ZERO);
}

#[test]
fn stray_points_cost_the_others_no_precision() {
    for (kind, precision) in [("double", 1e-4), ("float", 0.5)] {
        for (stray, strays) in [([0.0; 3], 1), ([1e9, -1e9, 1e9], 1), ([0.0; 3], 3000)] {
            let header = format!("property {kind} x\nproperty {kind} y\nproperty {kind} z\nend_header\n");
            let count = 20_000 + strays;
            let mut bytes = format!("ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{header}")
                .into_bytes();
            let place = |i: u32| {
                [500_000.0 + f64::from(i % 100) / 64.0, 4_600_000.0 + f64::from(i / 100) / 64.0, 100.0]
            };
            for position in (0..20_000).map(place).chain(std::iter::repeat_n(stray, strays)) {
                position.iter().for_each(|x| match kind {
                    "double" => bytes.extend(x.to_le_bytes()),
                    _ => bytes.extend((*x as f32).to_le_bytes()),
                });
            }
            let cloud = load(&bytes).cloud;
            let middle = DVec3::new(500_000.8, 4_600_001.5, 100.0);
            assert!(cloud.origin.distance(middle) < 4.0, "{kind}, {stray:?}: {}", cloud.origin);
            for (i, position) in (0..20_000).zip(&cloud.positions) {
                let apart = (cloud.origin + position.as_dvec3()).distance(place(i).into());
                assert!(apart < precision, "{kind}, {stray:?}, {i}: {apart}");
            }
        }
    }
}

#[test]
fn headers_of_many_names_are_read_at_once() {
    let start = ThreadTime::now();
    let many = |line: &str| -> String {
        (0..).map(|i| line.replace('#', &format!("{i:x}"))).take((1 << 20) / (line.len() + 6)).collect()
    };
    let vertex = format!("element vertex 1\n{FLOATS}");
    let records = [0u8; 28];
    for elements in [
        vertex.clone() + &many("element # 0\n"),
        many("element # 0\n") + &vertex,
        vertex + "element e 0\n" + &many("property int #\n"),
    ] {
        let header = format!("ply\nformat binary_little_endian 1.0\n{elements}end_header\n");
        let loaded = load(&[header.as_bytes(), &records].concat());
        assert!(loaded.report.elements.len() > 1 && loaded.cloud.len() == 1);
    }
    assert!(start.elapsed() < Duration::from_secs(2), "{:?}", start.elapsed());
}

#[test]
fn lying_counts_fail_at_once() {
    let start = ThreadTime::now();
    for format in ["ascii", "binary_little_endian", "binary_big_endian"] {
        for count in [10u64.pow(18), 1 << 63, u64::MAX] {
            let vertex = format!("element vertex {count}\n{FLOATS}");
            let list = format!("element vertex {count}\n{FLOATS}property list int int l\n");
            let before =
                format!("element face {count}\nproperty list uchar int i\nelement vertex 1\n{FLOATS}");
            for elements in [vertex, list, before] {
                let bytes =
                    format!("ply\nformat {format} 1.0\n{elements}end_header\n1 2 3 0 0 1 1 0\n").into_bytes();
                assert!(cause(&bytes).contains("the header claims"), "{elements}");
            }
            let empty = format!(
                "ply\nformat {format} 1.0\nelement none {count}\nelement vertex 0\n{FLOATS}end_header\n"
            );
            assert!(cause(empty.as_bytes()).contains("no points"));
        }
        let long = format!(
            "ply\nformat {format} 1.0\nelement face 1\nproperty list uint double i\nelement vertex 1\n{FLOATS}end_header\n"
        );
        let text = cause(&[long.as_bytes(), b"4000000000 1 2 3 4 5 6 7 8 9 0 1 2 3 4 5 6 7 8 9 0"].concat());
        assert!(text.contains("record 0 of element `face`"), "{text}");
    }
    assert!(start.elapsed() < Duration::from_millis(500));
}

#[test]
fn a_negative_list_length_is_refused() {
    let header = format!("element face 1\nproperty list char int i\nelement vertex 1\n{FLOATS}end_header\n");
    let text = cause(format!("ply\nformat ascii 1.0\n{header}-1 1 2 3 0 0 1 1").as_bytes());
    assert!(text.contains("`-1` is not a list length"), "{text}");
    let binary = format!("ply\nformat binary_little_endian 1.0\n{header}");
    assert!(cause(&[binary.as_bytes(), &[0xff; 64]].concat()).contains("list of negative length"));
}

#[test]
fn files_that_cannot_be_opened_are_named() {
    let text = read(Path::new("no/such.ply"), &ReadOptions::default(), &()).unwrap_err().to_string();
    assert!(text.starts_with("no/such.ply: cannot open: there is no such file"), "{text}");
    assert!(
        read(Path::new("/"), &ReadOptions::default(), &())
            .unwrap_err()
            .to_string()
            .starts_with("/: cannot read")
    );
}
