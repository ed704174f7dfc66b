//! Scans from text, and damage.

use super::*;
use crate::formats::read_bytes;
use crate::geometry::{Colours, View};

/// A quarter turn about z, x to y, and a position.
const TURNED: &str = "0 1 0 0\n-1 0 0 0\n0 0 1 0\n500000.25 4000000.5 100 1\n";

fn header(columns: u64, rows: u64, position: &str, transformation: &str) -> String {
    format!("{columns}\n{rows}\n{position}\n1 0 0\n0 1 0\n0 0 1\n{transformation}")
}

fn read(text: &str) -> crate::Result<Loaded> {
    read_bytes("a.ptx", text.as_bytes(), &ReadOptions::default())
}

fn identity(columns: u64, rows: u64) -> String {
    header(columns, rows, "0 0 0", "1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n")
}

#[test]
fn scans_are_in_the_coordinates_of_the_file_without_misses() {
    let first = header(2, 2, "500000.25 4000000.5 100", TURNED)
        + "1 2 3 0.5 255 0 7\n0 0 0 0.5 0 0 0\n-0.125 0 0 0.25 0 255 8\n0 0 1 1 1 2 3\n";
    let second = header(1, 1, "0 0 0", "1 0 0 0\n0 1 0 0\n0 0 1 0\n500001 4000001 99 1\n") + "1 1 1 0.75\n";
    for text in [format!("{first}{second}"), format!("{first}\n\n{second}\n \n").replace('\n', "\r\n")] {
        let options = ReadOptions { intensity: true, ..Default::default() };
        let Loaded { cloud, report, .. } = read_bytes("a", text.as_bytes(), &options).unwrap();
        assert_eq!((report.points, report.dropped.position), (5, 1));
        let exact = [
            [499_998.25, 4_000_001.5, 103.0],
            [500_000.25, 4_000_000.375, 100.0],
            [500_000.25, 4_000_000.5, 101.0],
            [500_002.0, 4_000_002.0, 100.0],
        ];
        let at: Vec<_> = cloud.positions.iter().map(|at| (cloud.origin + at.as_dvec3()).to_array()).collect();
        assert_eq!(at, exact);
        assert_eq!(cloud.scalar, Some(vec![0.5, 0.25, 1.0, 0.75]));
        let black = [0, 0, 0, 0];
        assert_eq!(
            cloud.colours,
            Some(Colours::Srgb8(vec![[255, 0, 7, 0], [0, 255, 8, 0], [1, 2, 3, 0], black]))
        );
        assert_eq!((cloud.view, report.up), (View::Unknown, Some(DVec3::Z)));
        let viewpoints = cloud.viewpoints.unwrap();
        assert_eq!(viewpoints.scans, [0, 0, 0, 1]);
        assert_eq!(
            viewpoints.view(3),
            View::From((DVec3::new(500_001.0, 4_000_001.0, 99.0) - cloud.origin).as_vec3())
        );
        let details: Vec<_> = report.details.iter().map(|(name, value)| format!("{name}: {value}")).collect();
        let expected = [
            "scans: 2",
            "scan 0: 2 × 2 points, from [500000.25, 4000000.5, 100]",
            "scan 1: 1 × 1 points, from [500001, 4000001, 99]",
        ];
        assert_eq!(details, expected);
    }
}

#[test]
fn the_scanner_of_a_single_scan_is_where_the_header_tells() {
    let from = |position: &str, transformation: &str| {
        let cloud = read(&(header(1, 1, position, transformation) + "1 1 1\n")).unwrap().cloud;
        let View::From(eye) = cloud.view else { panic!("{:?}", cloud.view) };
        cloud.origin + eye.as_dvec3()
    };
    let moved = "1 0 0 0\n0 1 0 0\n0 0 1 0\n0.5 -1 2 1\n";
    assert_eq!(from("0 0 0", moved), DVec3::new(0.5, -1.0, 2.0));
    assert_eq!(from("3 2 1", moved), DVec3::new(3.0, 2.0, 1.0));
}

#[test]
fn many_lines_are_read_in_pieces() {
    let points: String = (0..70_000).map(|i| format!("{i} {} 1 0.123456789\n", i % 100)).collect();
    assert!(points.len() > 1 << 20);
    // The last line has no end.
    let text = identity(700, 100) + points.trim_end() + "\n" + &identity(700, 100) + points.trim_end();
    let Loaded { cloud, report, .. } = read(&text).unwrap();
    assert_eq!((report.points, cloud.len()), (140_000, 140_000));
    let x = |i: usize| cloud.positions[i].x;
    assert!((0..70_000).all(|i| x(i) == i as f32 && x(70_000 + i) == i as f32));
}

#[test]
fn many_scans_take_no_longer_than_their_lines() {
    let text = (identity(1, 1) + "1 2 3\n").repeat(30_000);
    let start = cpu_time::ThreadTime::now();
    assert_eq!(read(&text).unwrap().report.points, 30_000);
    assert!(start.elapsed() < std::time::Duration::from_secs(4), "{:?}", start.elapsed());
}

#[test]
fn a_scan_is_distinguished_from_a_table() {
    let is = |text: &str| header::is_header(text.as_bytes());
    let text = identity(1, 1);
    assert!(is(&text) && is(&text[..text.len() / 2]) && is(&(text.clone() + "1 2 3 4\n")));
    for other in ["", "5\n", "3\n1 2 3\n4 5 6\n7 8 9\n", "1 2 3\n", "1\n2.5\n1 2 3\n", "3\n1\n1 2 3 4\n"] {
        assert!(!is(other), "{other:?}");
    }
}

#[test]
fn faults_are_named_with_their_lines() {
    let cases = [
        (identity(2, 1) + "1 2 3 4\n", "the scan at line 11 claims 2 × 1 points, but 1 lines follow"),
        (identity(1_000_000, 1_000_000) + "1 2 3 4\n", "claims 1000000 × 1000000 points, but 1 lines"),
        (identity(1 << 40, 1 << 40) + "1 2 3 4\n", "but 1 lines follow"),
        (identity(2, 1) + "1 2 3 4\n5 6 7\n", "line 12: 3 values, where the first line has 4"),
        (identity(2, 1) + "1 2 3 4\n5 6 x 8\n", "line 12: `x` is not a number"),
        (identity(3, 1) + "1 2 3 4\n\n5 6 7 8\n", "empty lines or comments stand between the points"),
        (identity(1, 1) + "1 2 3 4 5\n", "line 11: 5 values, but a point has x y z"),
        (identity(1, 1) + "1 2 3 4\n5 6 7 8\n", "line 12: `5 6 7 8` is not the number of columns"),
        (identity(1, 1).replace("0 0 1 0\n", "0 0 1\n") + "1 2 3 4\n", "line 9: `0 0 1` is not a row of the"),
        (identity(1, 1)[..14].to_owned(), "line 4: `1 0` is not the x axis"),
        (
            header(1, 1, "0 0 0", "1 0 0 5\n0 1 0 6\n0 0 1 7\n0 0 0 1\n") + "1 2 3\n",
            "line 7: the last column",
        ),
        (identity(2, 1) + "0 0 0 1\nnan 1 1 1\n", "none of its 2 points has a finite position"),
        (identity(0, 5), "it has no points"),
    ];
    for (text, expected) in cases {
        let cause = read(&text).unwrap_err().to_string();
        assert!(cause.contains(expected), "{text:?}: {cause}");
    }
}
