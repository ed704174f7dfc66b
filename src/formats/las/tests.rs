//! Files that laspy wrote from formulas (tools/format_samples), and damage to them.

use super::*;
use crate::formats::source::Source;
use crate::formats::{read, read_bytes};
use crate::geometry::srgb;
use glam::{DVec3, Vec3};
use std::path::PathBuf;

/// Number of points of each file.
const COUNT: u64 = 60;

/// All files, with their point formats.
fn files() -> impl Iterator<Item = (u8, PathBuf)> {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats"));
    let all = (0..=10).flat_map(|number| ["las", "laz"].map(|extension| (number, extension)));
    all.map(move |(number, extension)| (number, folder.join(format!("format{number}.{extension}"))))
}

/// A file's contents.
fn bytes(name: &str) -> Vec<u8> {
    std::fs::read(format!(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/{}"), name)).unwrap()
}

/// The stored coordinate of point `i`.
fn raw(i: u64, axis: usize) -> f64 {
    let (factor, modulus) = [(7919, 20011), (104_729, 30011), (1_299_709, 9973)][axis];
    (i * factor % modulus) as f64 - (modulus / 2) as f64
}

fn position(i: u64) -> DVec3 {
    DVec3::new(raw(i, 0) * 0.001 + 5e6, raw(i, 1) * 0.001 + 1e7, raw(i, 2) * 0.0005 - 100.0)
}

/// Each channel's code of 8 bits.
fn codes(i: u64) -> [u8; 3] {
    [i * 4, 255 - i, i * 7 % 256].map(|code| code as u8)
}

/// The formula of a field.
type Formula = fn(u64) -> f64;

/// Fields of a point format beside coordinates, colours and normals.
fn formulas(number: u8) -> Vec<(&'static str, Formula)> {
    let mut all: Vec<(&str, Formula)> = vec![
        ("intensity", |i| (i * 257) as f64),
        ("return_number", |i| (1 + i % 5) as f64),
        ("number_of_returns", |_| 5.0),
        ("classification", |i| (i % 32) as f64),
        ("synthetic", |i| (i % 2) as f64),
        ("key_point", |i| (i / 2 % 2) as f64),
        ("withheld", |i| (i / 3 % 2) as f64),
        ("scan_direction_flag", |i| (i / 7 % 2) as f64),
        ("edge_of_flight_line", |i| (i / 11 % 2) as f64),
        ("user_data", |i| (i * 3) as f64),
        ("point_source_id", |i| (i * 11) as f64),
    ];
    if number >= 6 {
        all.push(("overlap", |i| (i / 5 % 2) as f64));
        all.push(("scanner_channel", |i| (i % 4) as f64));
        all.push(("scan_angle", |i| ((i * 997 % 30001) as f64 - 15000.0) * 0.006));
    } else {
        all.push(("scan_angle", |i| i as f64 - 30.0));
    }
    if ![0, 2].contains(&number) {
        all.push(("gps_time", |i| 1e8 + i as f64 * 0.125));
    }
    if [8, 10].contains(&number) {
        all.push(("nir", |i| (i * 31) as f64));
    }
    if number % 2 == 1 {
        all.push(("big", |i| ((1u64 << 40) + i) as f64));
        all.push(("scaled", |i| (i as f64 - 30.0) * 0.01 + 3.0));
        all.push(("pair_0", |i| i as f64));
        all.push(("pair_1", |i| (2 * i) as f64));
    }
    all
}

#[test]
fn every_field_of_every_point_format_is_read() {
    for (number, path) in files() {
        for (name, formula) in formulas(number) {
            let options = ReadOptions { scalar: Some(name.into()), ..Default::default() };
            let Loaded { cloud, .. } = read(&path, &options, &()).unwrap();
            let expected: Vec<f64> = (0..COUNT).map(formula).collect();
            assert_eq!(cloud.scalar.unwrap(), expected, "{} {name}", path.display());
        }
    }
}

#[test]
fn positions_colours_and_extra_bytes_are_those_of_the_writer() {
    for (number, path) in files() {
        let Loaded { cloud, report, .. } = read(&path, &ReadOptions::default(), &()).unwrap();
        assert_eq!((report.points, report.dropped.total(), cloud.len() as u64), (COUNT, 0, COUNT));
        // Half a unit in the last place of f32 at the extent, which is far below the scale.
        let far = |(i, at): (u64, &Vec3)| (cloud.origin + at.as_dvec3() - position(i)).abs().max_element();
        let largest = (0..).zip(&cloud.positions).map(far).fold(0.0, f64::max);
        assert!(largest < 4e-6, "{}: {largest}", path.display());
        let has_colours = ![0, 1, 4, 6, 9].contains(&number);
        match cloud.colours {
            None => assert!(!has_colours),
            Some(Colours::Srgb8(all)) => {
                assert!([2, 7].contains(&number), "{number}: no channel above 255");
                assert!((0..).zip(&all).all(|(i, code)| code[..3] == codes(i)));
            }
            Some(Colours::Linear(all)) => {
                assert!(has_colours && ![2, 7].contains(&number));
                let exact = |i: u64| codes(i).map(|code| srgb::decode(f64::from(code) / 255.0) as f32);
                assert!((0..).zip(&all).all(|(i, colour)| *colour == exact(i)));
            }
        }
        assert_eq!(cloud.normals.is_some(), number % 2 == 1, "in extra bytes of odd formats");
        for (i, (normal, radius)) in
            (0..).zip(cloud.normals.iter().flatten().zip(cloud.radii.iter().flatten()))
        {
            assert_eq!((*normal, *radius), (Vec3::AXES[i % 3], 0.5 + i as f32 / 64.0));
        }
    }
}

#[test]
fn the_header_tells_version_scale_and_returns() {
    let Loaded { report, .. } = read_bytes("a.laz", &bytes("format7.laz"), &ReadOptions::default()).unwrap();
    let value =
        |name: &str| report.details.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str());
    assert_eq!(value("version"), Some("1.4"));
    assert_eq!(value("offset"), Some("5000000 10000000 -100"));
    assert_eq!(value("points by return"), Some("12 12 12 12 12"));
    assert_eq!((report.encoding, report.understood.len()), (Encoding::Compressed, 3 + 3 + 3 + 1));
}

#[test]
fn well_known_text_and_geotiff_keys_are_found() {
    let header = |records: Vec<(u16, Vec<u8>)>| {
        let file = bytes("format0.las");
        let input = Input { name: "a", source: Source::of(&file), folder: None };
        let mut header = Header::read(&input).unwrap();
        let record = |(id, data)| {
            let (user, description) = ("LASF_Projection".into(), String::new());
            header::Record { user, id, description, data }
        };
        header.records = records.into_iter().map(record).collect();
        details::of(&header).into_iter().find(|(name, _)| name == "coordinate system").map(|(_, value)| value)
    };
    assert_eq!(header(vec![]), None);
    assert_eq!(header(vec![(2112, b"PROJCS[\"UTM\"]\0\0".to_vec())]).as_deref(), Some("PROJCS[\"UTM\"]"));
    let keys = |all: &[u16]| all.iter().flat_map(|key| key.to_le_bytes()).collect::<Vec<u8>>();
    let geo = keys(&[1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, 25832]);
    let both = vec![(34735, geo.clone()), (34737, b"ETRS89 / UTM 32N|\0".to_vec())];
    assert_eq!(header(both).as_deref(), Some("EPSG:25832, ETRS89 / UTM 32N"));
    assert_eq!(header(vec![(34735, geo[..18].to_vec())]), None, "cut");
}

/// What reading a file fails with.
fn failure(bytes: &[u8]) -> String {
    read_bytes("a.las", bytes, &ReadOptions::default()).unwrap_err().to_string()
}

/// The file with some bytes replaced.
fn patched(name: &str, at: usize, with: &[u8]) -> Vec<u8> {
    let mut bytes = bytes(name);
    bytes[at..at + with.len()].copy_from_slice(with);
    bytes
}

#[test]
fn damage_is_named() {
    let has = |bytes: &[u8], what: &str| {
        let cause = failure(bytes);
        assert!(cause.contains(what), "{cause}: expected {what}");
    };
    // Offsets in the header: number of points 107, or 247 in version 1.4; point format 104, its size 105, offset of the points 96.
    has(&bytes("format0.las")[..100], "ends within its header");
    has(&bytes("format0.las")[..1000], "60 points of 20 bytes, but 773 bytes are left, 38 points");
    has(&patched("format0.las", 107, &u32::MAX.to_le_bytes()), "4294967295 points of 20 bytes");
    let many = patched("format6.las", 107, &0u32.to_le_bytes());
    assert!(read_bytes("a", &many, &ReadOptions::default()).is_ok(), "the count of version 1.4");
    let mut trillion = many;
    trillion[247..255].copy_from_slice(&1_000_000_000_000u64.to_le_bytes());
    has(&trillion, "1000000000000 points");
    has(&patched("format0.las", 104, &[11]), "format 11");
    has(&patched("format3.las", 105, &33u16.to_le_bytes()), "33 bytes, fewer than the 34");
    has(&patched("format0.las", 96, &5000u32.to_le_bytes()), "begin at byte 5000, beyond its end");
    has(&patched("format0.las", 107, &0u32.to_le_bytes()), "has no points");
    // Scales of 0 and NaN.
    let nan = patched("format0.las", 131, &f64::NAN.to_le_bytes());
    has(&nan, "none of its 60 points has a finite position");
    assert!(read_bytes("a", &patched("format0.las", 131, &[0; 8]), &ReadOptions::default()).is_ok());
}

#[test]
fn damage_of_compressed_points_is_named() {
    for name in ["format3.laz", "format7.laz"] {
        let whole = bytes(name);
        let start = u32::from_le_bytes(whole[96..100].try_into().unwrap()) as usize;
        let table = u64::from_le_bytes(whole[start..start + 8].try_into().unwrap()) as usize;
        let cut = failure(&whole[..whole.len() - 700]);
        assert!(cut.contains("no table of its compressed chunks"), "{cut}");
        let many = failure(&patched(name, table + 4, &u32::MAX.to_le_bytes()));
        assert!(many.contains("4294967295 compressed chunks"), "{many}");
        let more = failure(&patched(name, 107, &100_000u32.to_le_bytes()));
        assert!(more.contains("chunks hold 50000 of the 100000 points"), "{more}");
        // A chunk that ends early.
        let more = failure(&patched(name, 107, &40_000u32.to_le_bytes()));
        assert!(more.contains("compressed chunk 0") && more.contains("damaged"), "{more}");
        // The user of the first record, 2 bytes after the header.
        let header = usize::from(u16::from_le_bytes([whole[94], whole[95]]));
        let mut none = whole.clone();
        let user =
            none.windows(14).skip(header).position(|window| window == b"laszip encoded").unwrap() + header;
        none[user] = b'?';
        let none = failure(&none);
        assert!(none.contains("no record says how"), "{none}");
    }
    // Layers that are larger than the chunk.
    let whole = bytes("format7.laz");
    let start = u32::from_le_bytes(whole[96..100].try_into().unwrap()) as usize;
    let stride = usize::from(u16::from_le_bytes([whole[105], whole[106]]));
    let layers = failure(&patched("format7.laz", start + 8 + stride + 4, &u32::MAX.to_le_bytes()));
    assert!(layers.contains("larger than the chunk"), "{layers}");
}

#[test]
fn colours_of_zeros_are_none() {
    let black = Colours::Linear(vec![[0.0; 3]; 2]);
    assert_eq!(colours(black), None);
    let dark = Colours::Linear(vec![[decode(255.0, Scalar::U16), 0.0, decode(1.0, Scalar::U16)]]);
    assert_eq!(colours(dark), Some(Colours::Srgb8(vec![[255, 0, 1, 0]])));
    let deep = Colours::Linear(vec![[decode(256.0, Scalar::U16), 0.0, 0.0]]);
    assert_eq!(colours(deep.clone()), Some(deep));
}

/// The records of a file of point format 0, several times.
fn repeated(few: &[u8], times: u32) -> Vec<u8> {
    let start = u32::from_le_bytes(few[96..100].try_into().unwrap()) as usize;
    let mut many = few[..start].to_vec();
    (0..times).for_each(|_| many.extend_from_slice(&few[start..start + 60 * 20]));
    many[107..111].copy_from_slice(&(60 * times).to_le_bytes());
    many
}

#[test]
fn many_points_get_their_origin_from_some() {
    let few = bytes("format0.las");
    let many = repeated(&few, 10_000);
    let [few, many] =
        [&few, &many].map(|bytes| read_bytes("a", bytes, &ReadOptions::default()).unwrap().cloud);
    assert_eq!((many.len(), many.origin.is_finite()), (600_000, true));
    for i in [0, 59, 60, 300_017, 599_999] {
        let at = |cloud: &Cloud, i: usize| cloud.origin + cloud.positions[i].as_dvec3();
        assert!((at(&many, i) - at(&few, i % 60)).abs().max_element() < 4e-6, "{i}");
    }
    for scale in [f64::NAN, 1e300] {
        let none = failure(&repeated(&patched("format0.las", 131, &scale.to_le_bytes()), 10_000));
        assert!(none.contains("none of its 600000 points"), "{none}");
    }
}

#[test]
fn points_are_counted_by_class_and_return_whatever_the_filter_keeps() {
    use crate::formats::{Filter, FilterCounts};
    let read = |name: &str, filter: Filter, counts| {
        let options = ReadOptions { filter, counts, ..Default::default() };
        read_bytes(name, &bytes(name), &options).unwrap().report
    };
    // Point i is of class i mod 32 and is return i mod 5 + 1 of five.
    let counts = FilterCounts {
        classes: Some((0..32).map(|class| (class, if class < 28 { 2 } else { 1 })).collect()),
        returns: Some([12, 12, 0]),
    };
    let some = Filter { classes: Some(vec![3]), ..Default::default() };
    for name in ["format7.laz", "format7.las", "format1.laz"] {
        for filter in [Filter::default(), some.clone()] {
            let report = read(name, filter.clone(), true);
            assert_eq!(report.counts.as_ref(), Some(&counts), "{name}");
            // Neither counting nor filtering makes a model hold the class.
            assert!(report.skipped.contains(&"classification".into()), "{name}: {:?}", report.skipped);
            assert_eq!(read(name, filter, false).counts, None);
        }
    }
    let bare = ReadOptions { counts: true, ..Default::default() };
    let bare = read_bytes("a.xyz", b"1 2 3\n", &bare).unwrap().report;
    assert_eq!(bare.counts, Some(FilterCounts::default()), "it has neither classes nor returns");
}

#[test]
fn classes_and_returns_are_selected() {
    use crate::formats::{Filter, Returns};
    let read = |filter: Filter| {
        let options = ReadOptions { filter, scalar: Some("user_data".into()), ..Default::default() };
        read_bytes("a.laz", &bytes("format7.laz"), &options)
    };
    // The number of each point, by its user data.
    let kept = |filter: Filter| {
        let Loaded { cloud, report, .. } = read(filter).unwrap();
        assert_eq!(report.dropped.filtered, COUNT - cloud.len() as u64);
        cloud.scalar.unwrap().into_iter().map(|value| value as u64 / 3).collect::<Vec<_>>()
    };
    let expected = |is: fn(u64) -> bool| (0..COUNT).filter(|&i| is(i)).collect::<Vec<_>>();
    let classes = |classes: &[u8]| Filter { classes: Some(classes.into()), ..Default::default() };
    let returns = |returns| Filter { returns: Some(returns), ..Default::default() };
    assert_eq!(kept(Filter::default()), expected(|_| true));
    assert_eq!(kept(classes(&[2, 6])), expected(|i| [2, 6].contains(&(i % 32))));
    assert_eq!(kept(returns(Returns::First)), expected(|i| i % 5 == 0));
    assert_eq!(kept(returns(Returns::Last)), expected(|i| i % 5 == 4));
    let both = Filter { classes: Some(vec![4, 5]), returns: Some(Returns::Last), ..Default::default() };
    assert_eq!(kept(both), expected(|i| i % 32 == 4 && i % 5 == 4));
    let none = read(returns(Returns::Single)).unwrap_err().to_string();
    assert!(none.contains("none of its 60 points is left by the filter"), "{none}");
    let missing = ReadOptions { filter: classes(&[2]), ..Default::default() };
    let missing = read_bytes("a.xyz", b"1 2 3\n", &missing).unwrap_err().to_string();
    assert!(missing.contains("its points have no `classification`"), "{missing}");
}

/// The decoder of the table panics for some damage.
#[test]
fn a_damaged_table_of_chunks_is_an_error() {
    let whole = bytes("octree.copc.laz");
    let long = |at: usize| u64::from_le_bytes(std::array::from_fn(|byte| whole[at + byte])) as usize;
    let start = u32::from_le_bytes(std::array::from_fn(|byte| whole[96 + byte])) as usize;
    let table = long(start);
    let mut refused = 0;
    for at in table + 4..(table + 40).min(whole.len()) {
        for value in [0, 1, 0x10, 0x2c, 0x7f, 0x80, 0xff] {
            let mut damaged = whole.clone();
            damaged[at] = value;
            refused += u32::from(read_bytes("damaged.laz", &damaged, &ReadOptions::default()).is_err());
        }
    }
    assert!(refused > 50, "{refused}");
}
