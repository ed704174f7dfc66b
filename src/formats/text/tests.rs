//! Tables of several programs, and damage.

use super::*;
use crate::formats::{read, read_bytes};
use crate::geometry::Colours;
use glam::Vec3;
use std::path::PathBuf;

fn parsed(text: &str) -> crate::Result<Loaded> {
    read_bytes("a.xyz", text.as_bytes(), &ReadOptions::default())
}

fn understood(text: &str) -> Vec<String> {
    parsed(text).unwrap_or_else(|error| panic!("{text}: {error}")).report.understood
}

#[test]
fn files_of_open3d_agree() {
    for extension in ["xyz", "xyzn", "xyzrgb", "pts"] {
        let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats");
        let path = PathBuf::from(folder).join(format!("open3d.{extension}"));
        let Loaded { cloud, report, .. } = read(&path, &ReadOptions::default(), &()).unwrap();
        assert_eq!((report.points, cloud.len(), report.encoding), (60, 60, Encoding::Ascii), "{extension}");
        assert_eq!(cloud.positions[1], Vec3::new(-2.037_109_4, -0.301_757_8, -1.725_585_9));
        assert_eq!(cloud.normals.is_some(), extension == "xyzn");
        assert_eq!(cloud.colours.is_some(), ["xyzrgb", "pts"].contains(&extension));
        let codes = |i: u64| [i * 4, 255 - i, i * 7 % 256, 0].map(|code| code as u8);
        if let Some(Colours::Srgb8(colours)) = &cloud.colours {
            assert!((0..).zip(colours).all(|(i, code)| *code == codes(i)), "{extension}");
        }
    }
}

#[test]
fn names_come_from_the_first_line() {
    let x = ["x", "y", "z"];
    assert_eq!(understood("X;Y;Z;Intensity\n1;2;3;4\n"), x);
    assert_eq!(
        understood("\"x\",\"y\",\"z\",\"Red\",\"Green\",\"Blue\"\n1,2,3,4,5,6\n"),
        [&x[..], &["red", "green", "blue"]].concat()
    );
    assert_eq!(
        understood("//X Y Z R G B Nx Ny Nz\n1 2 3 4 5 6 0 0 1\n"),
        [&x[..], &["red", "green", "blue", "nx", "ny", "nz"]].concat()
    );
    assert_eq!(understood("# made by hand\n# x[m] radius y(m) z\n1 2 3 4\n"), ["x", "radius", "y", "z"]);
    assert_eq!(understood("id,x [m],y [m],z [m],radius\n7,1,2,3,4\n"), ["x", "y", "z", "radius"]);
    let Loaded { cloud, .. } = parsed("id,x,y,z\n7,1,2,3\n8,,5,6\n").unwrap();
    assert_eq!(
        (cloud.origin, cloud.len()),
        (glam::DVec3::new(1.0, 2.0, 3.0), 1),
        "an empty cell is no number"
    );
}

#[test]
fn names_of_other_programs_are_understood() {
    let (x, rgb, n) = (["x", "y", "z"], ["red", "green", "blue"], ["nx", "ny", "nz"]);
    let of = |names: &str, row: &str| understood(&format!("{names}\n{row}\n{row}\n"));
    assert_eq!(of("Easting,Northing,Elev,Red,Green,Blue", "1,2,3,4,5,6"), [x, rgb].concat());
    assert_eq!(of("Northing (m);Easting (m);Altitude (m)", "1;2;3"), ["y", "x", "z"]);
    assert_eq!(of("//X Y Z Rf Gf Bf", "1 2 3 0.5 0 1"), [x, rgb].concat());
    let paraview = "\"Normals:0\",\"Normals:1\",\"Normals:2\",\"Points:0\",\"Points:1\",\"Points:2\"";
    assert_eq!(of(paraview, "0,0,1,1,2,3"), [n, x].concat());
    assert_eq!(of("x,y,z,height", "1,2,3,4"), x, "a height beside z is another number");
    assert_eq!(of("\u{feff}x,y,z", "1,2,3"), x);
    assert_eq!(parsed("\u{feff}1 2 3\n").unwrap().cloud.origin, glam::DVec3::new(1.0, 2.0, 3.0));
    for (names, has) in [
        ("Lon,Lat,Height", "longitude and latitude (`Lon`, `Lat`, `Height`), which are degrees"),
        ("a,b,c,label", "(`a`, `b`, `c`, `label`): name the columns, for example `x,y,z,-`"),
        ("foo,x,Radius,b c,y,label", "for example `z,x,radius,-,y,-`"),
    ] {
        let row = ["1"; 8][..names.split(',').count() - 1].join(",");
        let row = if names.contains("label") { row + ",oak" } else { row + ",1" };
        for name in ["a.csv", "a"] {
            let error = read_bytes(name, format!("{names}\n{row}\n").as_bytes(), &ReadOptions::default());
            let error = error.unwrap_err().to_string();
            assert!(error.contains(has), "{error}");
        }
    }
}

#[test]
fn columns_are_named_and_ignored_by_the_caller() {
    let read = |text: &str, columns: &str| {
        let columns = Some(columns.split(',').map(str::to_owned).collect());
        read_bytes("a", text.as_bytes(), &ReadOptions { columns, ..Default::default() })
    };
    let rows = "oak,1,2,3,4\n,5,6,7,8\nash,5,6,8,8\n";
    for header in ["", "Tree,Foo,Bar,Baz,Radius\n", "# trees\n\n"] {
        let Loaded { cloud, report, .. } = read(&format!("{header}{rows}"), "-,x,z,y,-").unwrap();
        assert_eq!((cloud.len(), report.skipped.len(), cloud.radii.is_some()), (3, 0, false), "{header}");
        let first = cloud.origin + cloud.positions[0].as_dvec3();
        assert_eq!(first, glam::DVec3::new(1.0, 3.0, 2.0), "{header}");
    }
    assert_eq!(read("\u{feff}1 2 3 7\n", "x,y,z,radius").unwrap().cloud.radii, Some(vec![7.0]));
    for (columns, has) in [
        ("x,y,z", "lines have 5 values, and 3 columns are named: name each once, or `-` to ignore it"),
        ("tree,x,y,z,-", "column `tree` has text, `oak`: name the columns, for example `-,x,y,z,-`"),
        ("-,lon,lat,height,-", "longitude and latitude"),
        ("-,a,b,c,d", "for example `-,x,y,z,d`"),
    ] {
        let error = read(rows, columns).unwrap_err().to_string();
        assert!(error.contains(has), "{columns}: {error}");
    }
}

#[test]
fn columns_without_names_are_found_by_their_numbers() {
    let x = ["x", "y", "z"];
    let of = |row: &str| understood(&format!("{row}\n{row}\n"));
    assert_eq!(of("1 2 3"), x);
    assert_eq!(of("1 2 3 0.6 0 0.8"), [&x[..], &["nx", "ny", "nz"]].concat());
    assert_eq!(of("1\t2\t3\t200 0 0"), [&x[..], &["red", "green", "blue"]].concat());
    assert_eq!(of("1 2 3 -1613 52 70 64"), [&x[..], &["red", "green", "blue"]].concat());
    assert_eq!(of("1 2 3 7 8 1 2 3 0 1 0"), [&x[..], &["red", "green", "blue", "nx", "ny", "nz"]].concat());
    assert_eq!(of("1 2 3 -1 -2 -3"), x, "neither colours nor normals");
    let options = ReadOptions { scalar: Some("intensity".into()), ..Default::default() };
    let Loaded { cloud, .. } = read_bytes("a.pts", b"2\n1 2 3 -5 1 2 3\n1 2 4 -6 1 2 3\n", &options).unwrap();
    assert_eq!(cloud.scalar, Some(vec![-5.0, -6.0]));
    let columns = Some(["z", "y", "x"].map(str::to_owned).into());
    let named = read_bytes("a", b"1 2 3\n", &ReadOptions { columns, ..Default::default() }).unwrap();
    assert_eq!(named.cloud.origin, glam::DVec3::new(3.0, 2.0, 1.0));
}

#[test]
fn colours_are_codes_of_either_size_or_fractions() {
    let colours = |rgb: &str| parsed(&format!("x y z r g b\n1 2 3 {rgb}\n")).unwrap().cloud.colours.unwrap();
    assert_eq!(colours("255 0 1"), Colours::Srgb8(vec![[255, 0, 1, 0]]));
    assert_eq!(colours("1 0 0.5"), Colours::Srgb8(vec![[255, 0, 128, 0]]));
    assert_eq!(colours("65535 0 0"), Colours::Linear(vec![[1.0, 0.0, 0.0]]));
}

#[test]
fn long_files_are_read_in_pieces_with_comments_and_any_line_ends() {
    let count = 100_000;
    for end in ["\n", "\r\n", "\r"] {
        let mut text = format!("# a comment{end}{end}");
        for i in 0..count {
            text += &format!("{i} {} {}.25{end}", i % 7, i % 11);
            if i % 1000 == 0 {
                text += &format!("// {i}{end}{end}");
            }
        }
        assert!(text.len() > 1 << 20);
        let Loaded { cloud, report, .. } = parsed(&text).unwrap();
        assert_eq!((cloud.len(), report.points), (count, count as u64), "{end:?}");
        for (i, position) in cloud.positions.iter().enumerate() {
            let at = cloud.origin + position.as_dvec3();
            assert_eq!(at, glam::DVec3::new(i as f64, (i % 7) as f64, (i % 11) as f64 + 0.25));
        }
        let late = text.replacen(&format!("99998 3 8.25{end}"), &format!("99998 3{end}"), 1);
        let line = 3 + 99_998 + 2 * 100;
        let cause = parsed(&late).unwrap_err().to_string();
        assert!(cause.contains(&format!("line {line}: 2 values, where the first line has 3")), "{cause}");
    }
}

#[test]
fn another_number_of_points_than_the_file_states_is_reported() {
    let row = "1 2 3\n";
    let scans = |first: usize, second: usize| format!("2\n{}3\n{}", row.repeat(first), row.repeat(second));
    for (text, expected) in [
        (scans(2, 3), None),
        (scans(2, 2), Some(5)),
        (scans(2, 4), Some(5)),
        (row.repeat(4), None),
        // Over several pieces of a file.
        (scans(1 << 17, 1 << 17), Some(5)),
        (format!("{}\n{}", 1 << 18, row.repeat(1 << 18)), None),
    ] {
        assert_eq!(parsed(&text).unwrap().report.stated, expected);
    }
}

#[test]
fn damage_is_named() {
    let has = |text: &str, what: &str| {
        let cause = parsed(text).unwrap_err().to_string();
        assert!(cause.contains(what), "{cause}: expected {what}");
    };
    has("1 2 3\n4 5\n", "line 2: 2 values");
    has("1 2 3\n4 5 6 7\n", "line 2: 4 values");
    has("1 2 3\n4 five 6\n", "line 2: `five` is not a number");
    has("x,y,z\n", "no points");
    has("x,y,z\n1,2,3,4\n", "4 values, and 3 columns are named");
    has("nan nan nan\n", "none of its 1 points");
    has("", "is empty");
    has("1 2\n3 4\n", "not a point cloud");
    has("1.5,2,3,foo\n", "has text, `foo`: name the columns, for example `x,y,z,-`");
    has("x,y,z,tree\n1,2,3,oak\n", "column `tree` has text, `oak`: name the columns, for example `x,y,z,-`");
    let long = format!("1 2 3\n{}\n", "1 ".repeat(1 << 20));
    has(&long, "a line of more than 65536 bytes");
}
