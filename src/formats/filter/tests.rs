use super::*;
use crate::formats::round_trip::all;
use crate::formats::table::points::origin_of_some;
use crate::formats::table::{Arrays, Layout};
use crate::formats::{Attribute, Dropped, Faces, Loaded, ReadOptions, read_bytes};
use glam::Vec3;
use std::collections::BTreeMap;
use std::fmt::Write;

/// Options that keep all attributes of one point in `every`.
fn one_in(every: u64) -> ReadOptions {
    ReadOptions { filter: Filter { every: NonZeroU64::new(every), ..Default::default() }, ..all() }
}

/// Options that keep all attributes of the points in a box.
fn within(bounds: [DVec3; 2]) -> ReadOptions {
    ReadOptions { filter: Filter { bounds: Some(bounds), ..Default::default() }, ..all() }
}

#[test]
fn counts_of_two_files_are_added_and_what_one_lacks_is_not_counted() {
    let counts = |classes: &[(u8, u64)], returns| FilterCounts {
        classes: Some(classes.iter().copied().collect()),
        returns,
    };
    let (a, b) = (counts(&[(1, 5), (2, 1)], Some([3, 2, 1])), counts(&[(2, 4), (9, 1)], Some([1, 1, 1])));
    let both = counts(&[(1, 5), (2, 5), (9, 1)], Some([4, 3, 2]));
    assert_eq!(a.clone().merge(b), both);
    assert_eq!(a.clone().merge(counts(&[], None)).returns, None);
    assert_eq!(a.merge(FilterCounts::default()), FilterCounts::default());
}

/// A sample file by its name.
fn sample(name: &str) -> (String, Vec<u8>) {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/");
    (name.into(), std::fs::read(format!("{folder}{name}")).unwrap())
}

/// Lines of `count` points, each of which tells its number.
fn lines(count: usize, start: &str, end: &str) -> String {
    (0..count).fold(String::new(), |mut text, i| {
        let _ = writeln!(text, "{start}{i} {} {}{end}", i * 7 % 11, i * 5 % 13);
        text
    })
}

/// A PLY file with this encoding, and this property after x y z.
fn header(encoding: &str, count: usize, property: &str) -> String {
    let xyz = "property float x\nproperty float y\nproperty float z";
    format!("ply\nformat {encoding} 1.0\nelement vertex {count}\n{xyz}\n{property}end_header\n")
}

/// Files of several blocks and pieces, by name.
fn files() -> Vec<(String, Vec<u8>)> {
    let binary = (0..30_000).flat_map(|i| [i as f32, (i % 11) as f32, 1.0]).flat_map(f32::to_be_bytes);
    let gaussian = |i: u32| {
        let floats = [i as f32, (i % 11) as f32, 1.0, 1.0, 2.0, 0.1].map(f32::to_le_bytes);
        [floats.concat(), vec![9, 8, 7, 255, 255, 128, 128, 128]].concat()
    };
    let grid = "25\n52\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n1 0 0 0\n0 1 0 0\n0 0 1 0\n0 0 0 1\n";
    let text = |name: &str, text: String| (name.to_owned(), text.into_bytes());
    vec![
        text("a.xyz", lines(1300, "", "")),
        text("a.ptx", format!("{grid}{}", lines(1300, "1", " 0.5"))),
        text("a.obj", lines(1300, "v ", "")),
        text("ascii.ply", header("ascii", 1300, "") + &lines(1300, "", "")),
        text("lists.ply", header("ascii", 1300, "property list uchar int a\n") + &lines(1300, "", " 1 2")),
        (
            "binary.ply".into(),
            [header("binary_big_endian", 30_000, "").into_bytes(), binary.collect()].concat(),
        ),
        ("a.splat".into(), (0..1300).flat_map(gaussian).collect()),
        #[cfg(feature = "las")]
        sample("format7.las"),
        #[cfg(feature = "las")]
        sample("format7.laz"),
        #[cfg(feature = "pcd")]
        sample("binary.pcd"),
    ]
}

/// A part of a large survey keeps its digits: its positions are relative to its own middle.
#[test]
fn the_origin_is_that_of_the_points_in_the_box() {
    let row: Vec<DVec3> = (0..1000).map(|i| DVec3::new(5e5 + 100.0 * f64::from(i), 4e6, 0.0)).collect();
    let bounds = [DVec3::new(5.7e5, 0.0, -1.0), DVec3::new(5.71e5, 5e6, 1.0)];
    let filter = Filter { bounds: Some(bounds), ..Default::default() };
    let far = |origin: DVec3| (origin.x - 5.705e5).abs();
    assert!(far(origin_of_some(row.clone(), &Filter::default()).unwrap()) > 1e4);
    assert!(far(origin_of_some(row.clone(), &filter).unwrap()) < 2e3);
    // Too few of them say nothing of the others.
    assert_eq!(origin_of_some(row[..707].to_vec(), &filter), None);
}

#[test]
fn numbers_of_points_are_those_from_the_first_on() {
    let thinned = |every, count| one_in(every).filter.thinned(count);
    assert_eq!([0, 1, 3, 4, 7].map(|count| thinned(3, count)), [0, 1, 1, 2, 3]);
    assert_eq!([0, 1, 3].map(|count| thinned(1, count)), [0, 1, 3]);
    assert_eq!(thinned(u64::MAX, u64::MAX), 1);
    assert!(one_in(1).filter.is_none() && !one_in(2).filter.is_none());
}

#[test]
fn every_reader_reads_one_point_in_n() {
    for (name, bytes) in files() {
        let read = |options: &ReadOptions| read_bytes(&name, &bytes, options).unwrap();
        let whole = read(&all());
        assert_eq!(whole.report.dropped, Dropped::default(), "{name}");
        for every in [1, 7, 600, u64::MAX] {
            let Loaded { cloud, report, attributes } = read(&one_in(every));
            let indices: Vec<usize> =
                (0..whole.cloud.len()).filter(|i| (*i as u64).is_multiple_of(every)).collect();
            assert_eq!((cloud.len(), report.points), (indices.len(), whole.report.points), "{name}");
            let thinned = (whole.cloud.len() - cloud.len()) as u64;
            assert_eq!(report.dropped, Dropped { thinned, ..Default::default() }, "{name}");
            assert_points(&attributes, &whole, &indices, &format!("{name}: one in {every}"));
        }
    }
}

/// Asserts that attributes are those of some of the points.
fn assert_points(attributes: &[Attribute], whole: &Loaded, indices: &[usize], what: &str) {
    assert!(attributes.len() >= 3 && attributes.len() == whole.attributes.len(), "{what}");
    for (own, of_all) in attributes.iter().zip(&whole.attributes) {
        let expected = indices.iter().map(|&i| of_all.values.get(i).map(f64::to_bits));
        let values = (0..indices.len()).map(|i| own.values.get(i).map(f64::to_bits));
        assert!(values.eq(expected), "{what}: {}", own.name);
    }
}

#[test]
fn every_reader_reads_the_points_in_a_box() {
    let mut files = files();
    if cfg!(feature = "e57") {
        files.push(sample("scans.e57"));
    }
    for (name, bytes) in files {
        let read = |options: &ReadOptions| read_bytes(&name, &bytes, options).unwrap();
        let whole = read(&all());
        let x = |position: &Vec3| whole.cloud.origin.x + f64::from(position.x);
        let mut sorted: Vec<f64> = whole.cloud.positions.iter().map(x).collect();
        sorted.sort_by(f64::total_cmp);
        sorted.dedup();
        // Between coordinates of points, which are rounded.
        let [low, high] =
            [4, 2].map(|part| sorted.len() / part).map(|rank| sorted[rank - 1].midpoint(sorted[rank]));
        let is_inside = |i: &usize| (low..=high).contains(&x(&whole.cloud.positions[*i]));
        let indices: Vec<usize> = (0..whole.cloud.len()).filter(is_inside).collect();
        let bounds = [f64::NEG_INFINITY, f64::INFINITY].map(DVec3::splat);
        let options = within([bounds[0].with_x(low), bounds[1].with_x(high)]);
        let Loaded { cloud, report, attributes } = read(&options);
        assert_eq!((cloud.len(), report.points), (indices.len(), whole.report.points), "{name}");
        let filtered = (whole.cloud.len() - cloud.len()) as u64;
        assert!(filtered > 0 && !cloud.is_empty(), "{name}");
        assert_eq!(report.dropped, Dropped { filtered, ..whole.report.dropped }, "{name}");
        assert_points(&attributes, &whole, &indices, &name);
        assert_eq!(read(&within(bounds)), whole, "{name}");
    }
}

#[test]
fn sides_of_the_box_belong_to_it_and_points_outside_are_not_counted() {
    let text =
        "//x y z classification\n0 0 0 2\n1 0 0 2\n2 0 0 5\n3 0 0 5\nnan 0 0 2\n5 0 0 2\n2 1 0 5\n2 0 -1 5\n";
    let options = ReadOptions { counts: true, ..within([DVec3::X, DVec3::new(3.0, 0.5, 0.0)]) };
    let Loaded { cloud, report, .. } = read_bytes("a.xyz", text.as_bytes(), &options).unwrap();
    assert_eq!(cloud.positions.iter().map(|position| position.x).collect::<Vec<_>>(), [1.0, 2.0, 3.0]);
    assert_eq!(report.dropped, Dropped { position: 1, filtered: 4, ..Default::default() });
    let counts = report.counts.and_then(|counts| counts.classes);
    assert_eq!(counts, Some(BTreeMap::from([(2, 1), (5, 2)])));
    let none = read_bytes("a.xyz", text.as_bytes(), &within([DVec3::splat(9.0); 2])).unwrap_err().to_string();
    assert!(none.contains("none of its 8 points is left by the filter: choose other bounds"), "{none}");
}

/// Tiles share the points at their common side alone.
#[test]
fn points_a_millimetre_outside_of_a_large_box_are_left_out() {
    let text = (-3..=3).fold(String::new(), |mut text, i| {
        let _ = writeln!(text, "{} 0 0", 10_000.0 + 0.001 * f64::from(i));
        text
    });
    let count = |min: f64, max: f64| {
        let bounds = [DVec3::new(min, -1.0, -1.0), DVec3::new(max, 20_000.0, 1.0)];
        read_bytes("a.xyz", text.as_bytes(), &within(bounds)).unwrap().cloud.len()
    };
    assert_eq!([count(0.0, 1e4), count(1e4, 2e4), count(0.0, 2e4)], [4, 4, 7]);
}

#[test]
fn the_bounds_of_the_report_keep_all_points_and_narrower_ones_do_not() {
    let mut files = files();
    if cfg!(feature = "e57") {
        files.push(sample("scans.e57"));
    }
    for (name, bytes) in files {
        let read = |bounds| read_bytes(&name, &bytes, &within(bounds)).unwrap();
        let whole = read([f64::NEG_INFINITY, f64::INFINITY].map(DVec3::splat));
        let [min, max] = whole.report.bounds.unwrap();
        assert_eq!(read([min, max]), whole, "{name}");
        for narrower in [[min.with_x(min.x.next_up()), max], [min, max.with_y(max.y.next_down())]] {
            assert!(read(narrower).report.dropped.filtered > 0, "{name}: {narrower:?}");
        }
    }
}

/// The points of two scans count on, those without a position too.
#[cfg(feature = "e57")]
#[test]
fn one_point_in_n_of_all_scans_is_read() {
    let (name, bytes) = sample("scans.e57");
    let read = |options: &ReadOptions| read_bytes(&name, &bytes, options).unwrap();
    let rows = |loaded: &Loaded| -> Vec<Vec<u64>> {
        let of = |i| loaded.attributes.iter().map(|own| own.values.get(i).unwrap().to_bits()).collect();
        (0..loaded.cloud.len()).map(of).collect()
    };
    let (whole, thinned) = (rows(&read(&all())), read(&one_in(3)));
    let (points, dropped) = (thinned.report.points, thinned.report.dropped);
    assert_eq!(dropped.thinned, points - points.div_ceil(3));
    assert_eq!(thinned.cloud.len() as u64, points.div_ceil(3) - dropped.position);
    // In file order.
    let mut others = whole.iter();
    assert!(rows(&thinned).iter().all(|row| others.any(|other| other == row)));
}

#[test]
fn other_conditions_hold_for_the_points_that_are_left() {
    let text = "//x y z classification\n0 0 0 2\n1 0 0 2\n2 0 0 5\n3 0 0 5\nnan 0 0 2\n5 0 0 2\n6 0 0 2\n";
    let mut options = one_in(2);
    options.filter.classes = Some(vec![2]);
    let Loaded { cloud, report, .. } = read_bytes("a.xyz", text.as_bytes(), &options).unwrap();
    assert_eq!(cloud.positions.iter().map(|position| position.x).collect::<Vec<_>>(), [0.0, 6.0]);
    assert_eq!(report.dropped, Dropped { position: 1, thinned: 3, filtered: 1, ..Default::default() });
    let none = read_bytes("a.xyz", b"nan 0 0\n1 2 3\n", &one_in(2)).unwrap_err().to_string();
    assert!(none.contains("none of the 1 that are read of its 2 points is left"), "{none}");
}

#[test]
fn faces_and_radii_belong_to_all_points() {
    let faces = "element face 2\nproperty list uchar int vertex_indices\n";
    let radius = "property float radius\n";
    let ply = header("ascii", 5, &format!("{radius}{faces}"));
    let ply = format!("{ply}0 0 0 1\n1 0 0 1\n2 0 0 1\n3 1 0 1\n4 4 0 1\n3 0 2 4\n3 0 1 2\n");
    let read = |options: &ReadOptions| read_bytes("a.ply", ply.as_bytes(), options).unwrap();
    let Loaded { cloud, report, .. } = read(&all());
    assert_eq!((cloud.radii, report.faces), (Some(vec![1.0; 5]), Faces { understood: 2, skipped: 0 }));
    let Loaded { cloud, report, .. } = read(&one_in(2));
    assert_eq!((cloud.len(), cloud.triangles.len(), cloud.radii), (3, 0, None));
    assert_eq!(report.faces, Faces { understood: 0, skipped: 2 });
}

#[test]
fn memory_is_that_of_the_points_that_are_left() {
    let Loaded { report, .. } = read_bytes("a.xyz", b"1 2 3\n", &all()).unwrap();
    let layout = Layout::of(&report.elements[0], &one_in(1 << 30), false).unwrap();
    let arrays = Arrays::new(1 << 40, &layout).unwrap();
    assert_eq!(arrays.wide.len() + arrays.narrow.len(), 1 << 10);
}
