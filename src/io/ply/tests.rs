//! Whole files, in memory and from the shared test data.

use super::*;
use crate::geometry::Colours;
use glam::{DVec3, Vec3};
use proptest::prelude::*;
use std::path::PathBuf;
use std::time::{Duration, Instant};

const FLOATS: &str = "property float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
                      property float nz\nproperty float radius\n";

fn ascii(count: usize, more: &str, records: &str) -> Vec<u8> {
    format!("ply\nformat ascii 1.0\nelement vertex {count}\n{FLOATS}{more}end_header\n{records}").into_bytes()
}

fn load(bytes: &[u8]) -> Loaded {
    read_bytes("test.ply", bytes).unwrap_or_else(|error| panic!("{error}"))
}

fn cause(bytes: &[u8]) -> String {
    read_bytes("test.ply", bytes).unwrap_err().to_string()
}

/// Two vertices, after an element of lists and before one; a list and a number that is not understood stand among the numbers.
fn mixed(format: &str) -> Vec<u8> {
    let header = format!(
        "ply\nformat {format} 1.0\nelement face 2\nproperty list uchar int vertex_indices\nproperty short tag\n\
         element vertex 2\nproperty double x\nproperty list ushort double rays\nproperty int y\nproperty uchar z\nproperty char nx\n\
         property short ny\nproperty float nz\nproperty float radius\nproperty uint id\nproperty ushort red\nproperty ushort green\n\
         property ushort blue\nelement edge 1000000\nproperty int a\nend_header\n"
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
        let Loaded { surfels, report } = load(&mixed(format));
        assert_eq!(report.format.to_string(), format);
        let points: Vec<DVec3> = surfels.positions.iter().map(|p| surfels.origin + p.as_dvec3()).collect();
        assert_eq!(points, [DVec3::new(-100.5, 4.0, 3.0), DVec3::new(10.0, -3.0, 200.0)], "{format}");
        assert_eq!(surfels.normals, [Vec3::new(0.0, 0.6, 0.8), -Vec3::X], "{format}");
        assert_eq!(surfels.radii, [0.5, 0.25]);
        let Some(Colours::Linear(colours)) = &surfels.colours else { panic!("{format}: no linear colours") };
        assert_eq!((colours[1][0], colours[1][1]), (0.0, 1.0));
        assert!((colours[1][2] - 0.177_015).abs() < 1e-5, "{colours:?}");
        assert_eq!(report.skipped, ["rays", "id"]);
        assert_eq!(report.understood, ["x", "y", "z", "nx", "ny", "nz", "radius", "red", "green", "blue"]);
        assert_eq!(report.elements.iter().map(|e| e.count).collect::<Vec<_>>(), [2, 2, 1_000_000]);
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
        "1 2 3 0 0 1 .5\r3 2 1 1 0 0 1E-3 77 trailing",
    ] {
        assert_eq!(load(&ascii(2, "", records)), plain, "{records:?}");
    }
    assert!(
        cause(&ascii(1, "", "1 2 x 0 0 1 1")).contains("record 0 of element `vertex`, `z`: `x` is no number")
    );
    assert!(cause(&ascii(2, "", "1.5 2.5 3.5 0 0 1 1 1 2 3 0 0 1")).contains("`radius`: the file ends here"));
}

#[test]
fn what_cannot_be_drawn_is_dropped_and_counted() {
    let records = "nan 0 0 0 0 1 1\n0 inf 0 0 0 0 0\n1e39 0 0 0 0 1 1\n0 0 0 0 0 1 0\n0 0 0 0 0 1 -1\n0 0 0 0 0 1 1e-60\n\
                   0 0 0 0 0 1 nan\n0 0 0 0 0 0 1\n0 0 0 0 nan 1 1\n0 0 0 1e-300 0 0 1\n0 0 0 0 -1e300 0 2\n";
    let Loaded { surfels, report } = load(&ascii(11, "", records));
    assert_eq!(report.dropped, Dropped { position: 3, radius: 4, normal: 2 });
    assert_eq!((report.points, report.dropped.total()), (11, 9));
    assert_eq!((surfels.normals, surfels.radii), (vec![Vec3::X, -Vec3::Y], vec![1.0, 2.0]));
    assert!(
        cause(&ascii(1, "", "nan 0 0 0 0 1 1")).contains("none of its 1 vertices can be drawn: 1 positions")
    );
    assert!(cause(&ascii(0, "", "")).contains("no vertices"));
}

#[test]
fn colours_come_in_three_kinds() {
    let colours = |kind: &str, values: &str| {
        let more: String = ["red", "green", "blue"].map(|name| format!("property {kind} {name}\n")).concat();
        load(&ascii(1, &more, &format!("0 0 0 0 0 1 1 {values}"))).surfels.colours
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
    let surfels = load(&bytes).surfels;
    let across = surfels.positions[0] - surfels.positions[1];
    assert!((f64::from(across.x.abs()) - 0.875_000_5).abs() < 1e-7, "{across}");
    assert!((surfels.origin.x - 10_000_000.562_5).abs() < 1e-6, "{}", surfels.origin);
    // Ordinary coordinates stay as they are.
    assert_eq!(load(&ascii(2, "", "0.1 0 0 0 0 1 1 1 0 0 0 0 1 1")).surfels.origin, DVec3::ZERO);
}

#[test]
fn lying_counts_fail_at_once() {
    let start = Instant::now();
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
            assert!(cause(empty.as_bytes()).contains("no vertices"));
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
    assert!(text.contains("`-1` is no length"), "{text}");
    let binary = format!("ply\nformat binary_little_endian 1.0\n{header}");
    assert!(cause(&[binary.as_bytes(), &[0xff; 64]].concat()).contains("negative length"));
}

fn random_surfels(count: usize, origin: DVec3, colours: Option<Colours>) -> Surfels {
    let spread = |i: usize, k: f32| ((i as f32 * k).sin() * 1e3).fract();
    let mut surfels = Surfels {
        origin,
        positions: (0..count).map(|i| Vec3::new(spread(i, 1.0), spread(i, 2.0), spread(i, 3.0))).collect(),
        normals: (0..count).map(|i| Vec3::new(spread(i, 4.0), 1.0, spread(i, 5.0)).normalize()).collect(),
        radii: (0..count).map(|i| 0.5 + 0.1 * spread(i, 6.0)).collect(),
        colours,
        ..Default::default()
    };
    surfels.sort_morton();
    surfels
}

#[test]
fn what_is_written_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out.ply");
    let srgb = Colours::Srgb8((0..100).map(|i| [i, 255 - i, 7, 0]).collect());
    let linear = Colours::Linear((0..100).map(|i| [i as f32 / 99.0, 0.5, 0.0]).collect());
    for colours in [None, Some(srgb), Some(linear)] {
        let surfels = random_surfels(100, DVec3::ZERO, colours);
        write(&path, &surfels).unwrap();
        let read = read(&path).unwrap().surfels;
        assert_eq!(
            (&read.positions, &read.radii, &read.colours),
            (&surfels.positions, &surfels.radii, &surfels.colours)
        );
        assert!(read.normals.iter().zip(&surfels.normals).all(|(a, b)| a.abs_diff_eq(*b, 2e-7)));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "a temporary file was left");
    }
    let far = random_surfels(100, DVec3::new(5e6, -4e5, 120.25), None);
    write(&path, &far).unwrap();
    let (read, far) = (read(&path).unwrap().surfels, far.bounds().unwrap());
    assert!(read.bounds().unwrap().max.abs_diff_eq(far.max, 1e-6), "{:?} {far:?}", read.bounds());
    let ragged = Surfels { radii: vec![], ..read };
    assert!(matches!(write(&path, &ragged), Err(Error::Usage(_))));
}

#[test]
fn files_that_cannot_be_opened_are_named() {
    let text = read(Path::new("no/such.ply")).unwrap_err().to_string();
    assert!(text.starts_with("no/such.ply: cannot open: there is no such file"), "{text}");
    assert!(read(Path::new("/")).unwrap_err().to_string().starts_with("/: cannot read"));
}

/// The shared test data; `None`, and a line that says so, where it is not there.
fn data(part: &str) -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data").join(part);
    if !folder.exists() {
        eprintln!("SKIPPED: there is no {}", folder.display());
        return None;
    }
    Some(folder)
}

#[test]
fn odd_files_of_other_programs_load_or_fail_in_one_line() {
    let Some(folder) = data("ply_edge") else { return };
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "ply"));
    assert!(files.len() > 100, "{}", files.len());
    for path in files {
        let start = Instant::now();
        let text = read(&path)
            .map_or_else(|error| error.to_string(), |loaded| format!("{} points", loaded.report.points));
        assert!(start.elapsed() < Duration::from_secs(1), "{}", path.display());
        assert!(text.lines().count() == 1 && text.len() < 400, "{text}");
        println!("{text}");
    }
}

/// plyfile 1.1.5 is the judge of how many vertices a file has, or whether it can be read at all, apart from the files listed.
#[test]
fn odd_files_decode_as_another_reader_does() {
    // Accepted here alone: a record that an empty line precedes, obj_info among the properties. Refused here alone: a header over the limit, a
    // list length of type float.
    const LENIENT: &[(&str, usize)] =
        &[("iterply_leading_blank_row.ply", 1), ("plyrs__empty_ok_ascii.ply", 0)];
    const STRICT: &[&str] = &[
        "sceneio_oversized_comment.ply",
        "mlsgpu_BadPropertyListType.ply",
        "playcanvas__test_assets_test.ply",
    ];
    let Some(folder) = data("ply_edge") else { return };
    let manifest = std::fs::read_to_string(folder.join("MANIFEST.tsv")).unwrap();
    let mut judged = 0;
    for line in manifest.lines().skip(1) {
        let cells: Vec<&str> = line.split('\t').collect();
        let bytes = std::fs::read(folder.join(cells[0])).unwrap();
        let count = cells[6].split(' ').find_map(|word| word.strip_prefix("vertex=")?.parse::<usize>().ok());
        match decode_positions(&bytes) {
            Ok(len) if LENIENT.contains(&(cells[0], len)) => {}
            Ok(len) => assert_eq!(Some(len), count, "{line}"),
            Err(cause) if STRICT.contains(&cells[0]) || cause == "no positions" => {}
            Err(cause) => assert!(!cells[6].starts_with("ok"), "{line}: {cause}"),
        }
        judged += 1;
    }
    assert!(judged > 150, "{judged}");
}

/// Number of vertices of a file that may have nothing but positions.
fn decode_positions(bytes: &[u8]) -> Parsed<usize> {
    let header = header::parse(bytes)?;
    header::refuse_duplicates(&header.elements)?;
    let vertex = layout::find_vertex(&header.elements).map_err(|_| "no positions")?;
    let properties = &header.elements[vertex].properties;
    let mut columns = [None; layout::COLUMNS];
    for (column, name) in ["x", "y", "z"].iter().enumerate() {
        columns[column] = Some(properties.iter().position(|p| p.name == *name).ok_or("no positions")?);
    }
    let table = table::Table::open(bytes, &header, vertex, &layout::Layout { columns, colour: None })?;
    Ok(table.len())
}

#[test]
fn odd_files_give_what_their_authors_say() {
    let Some(folder) = data("ply_edge") else { return };
    let text = |name: &str| read(&folder.join(name)).unwrap_err().to_string();
    let surfels = read(&folder.join("mlsgpu_Read_yzx_radius.ply")).unwrap().surfels;
    for i in 0..5 {
        let at = 100.0 * i as f32;
        assert_eq!((surfels.positions[i], surfels.radii[i]), (Vec3::new(at + 2.0, at, at + 1.0), at + 6.0));
    }
    for (name, expected) in [
        ("meshio__tests_meshes_ply_tet.ply", "git lfs pull"),
        ("playcanvas__test_assets_test.ply", "compressed 3D Gaussians"),
        ("plapoint_property_long.ply", "64-bit integer"),
        ("mlsgpu_DuplicateProperty.ply", "two properties named"),
        ("mlsgpu_ShortFile.ply", "the header claims 5 records"),
        ("mlsgpu_FormatAscii.ply", "is no number"),
        ("sceneio_oversized_comment.ply", "longer than 1048576"),
        ("topocore_blank_lines_in_header.ply", "no x y z"),
        ("assimp__invalid_empty.ply", "is empty"),
        ("trimesh__models_points_ascii_with_lists.ply", "neither normals (nx ny nz) nor a radius"),
        ("lox__sphere_vnormals_ascii.ply", "have no radius"),
    ] {
        assert!(text(name).contains(expected), "{}", text(name));
    }
}

#[test]
fn classic_point_clouds_load_whole() {
    let Some(folder) = data("classic") else { return };
    for (name, count) in [("bunny16k.ply", 16130), ("chameleon4k.ply", 4594)] {
        let Loaded { surfels, report } = read(&folder.join(name)).unwrap();
        assert_eq!(
            (surfels.len() as u64 + report.dropped.total(), report.dropped.total()),
            (count, 0),
            "{name}"
        );
        assert!(surfels.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-6), "{name}");
        assert_eq!(surfels.colours.as_ref().map(Colours::len), Some(count as usize));
        assert_eq!(report.skipped, ["alpha"]);
        let bounds = surfels.bounds().unwrap();
        assert!(bounds.radius.is_finite() && bounds.radius > 0.0, "{bounds:?}");
        println!("{name}: {bounds:?}, origin {}", surfels.origin);
    }
}

fn arbitrary_line() -> impl Strategy<Value = String> {
    let word = prop::sample::select(vec![
        "ply",
        "format",
        "ascii",
        "binary_little_endian",
        "binary_big_endian",
        "1.0",
        "element",
        "vertex",
        "face",
        "property",
        "list",
        "uchar",
        "int",
        "double",
        "float",
        "x",
        "y",
        "z",
        "nx",
        "ny",
        "nz",
        "radius",
        "0",
        "1",
        "3",
        "18446744073709551615",
        "comment",
        "end_header",
    ]);
    prop::collection::vec(word, 0..6).prop_map(|words| words.join(" "))
}

proptest! {
    #[test]
    fn nonsense_never_panics(lines in prop::collection::vec(arbitrary_line(), 0..12), tail: Vec<u8>) {
        let text = [b"ply\n", lines.join("\n").as_bytes(), b"\nend_header\n", &tail].concat();
        let _ = read_bytes("nonsense", &text);
    }

    #[test]
    fn damaged_files_never_panic(format in 0..3usize, changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let mut bytes = mixed(["ascii", "binary_little_endian", "binary_big_endian"][format]);
        for (index, byte) in changes {
            let at = index.index(bytes.len());
            bytes[at] = byte;
        }
        if let Err(error) = read_bytes("damaged", &bytes) {
            prop_assert_eq!(error.to_string().lines().count(), 1);
        }
    }
}
