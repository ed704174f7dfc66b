//! A file that copclib wrote (tools/format_samples), and damage to it.

use super::*;
use crate::formats::reader::Input;
use crate::formats::{Filter, Loaded, ReadOptions, levels, read, read_bytes};
use crate::geometry::Cloud;
use std::path::PathBuf;

/// Offset of the root's page in the record after the header.
const ROOT: usize = 375 + 54 + 40;

fn path() -> PathBuf {
    PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/octree.copc.laz"))
}

/// Options that read as many points.
fn least(min_points: Option<u64>) -> ReadOptions {
    ReadOptions { min_points, scalar: Some("intensity".into()), ..Default::default() }
}

/// The numbers of the points, which are their intensities.
fn numbers(cloud: &Cloud) -> Vec<u64> {
    let mut all: Vec<u64> =
        cloud.scalar.iter().flatten().map(|intensity| (*intensity / 257.0) as u64).collect();
    all.sort_unstable();
    all
}

#[test]
fn coarse_levels_are_read_as_far_as_they_are_needed() {
    assert_eq!(levels(&path()).unwrap(), [20, 20, 20]);
    let plain = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/formats/format7.laz"));
    assert!(levels(&plain).unwrap().is_empty());
    for (enough, expected) in
        [(None, 3), (Some(1), 1), (Some(20), 1), (Some(21), 2), (Some(41), 3), (Some(1000), 3)]
    {
        let Loaded { cloud, report, .. } = read(&path(), &least(enough), &()).unwrap();
        let all: Vec<u64> = (0..60).filter(|point| point % 3 < expected).collect();
        assert_eq!(numbers(&cloud), all, "{enough:?}");
        assert_eq!((report.points, report.dropped.thinned), (60, 60 - all.len() as u64), "{enough:?}");
        let reported =
            report.details.iter().find(|(name, _)| name == "octree").map(|(_, text)| text.as_str());
        let expected = "22 nodes in 3 levels, spacing 8.000 to 2.000, points by level 20 20 20";
        assert_eq!(reported, Some(expected));
    }
}

#[test]
fn damage_is_reported_and_matters_to_coarse_levels_alone() {
    let file = std::fs::read(path()).unwrap();
    let long = |at: usize| u64::from_le_bytes(std::array::from_fn(|byte| file[at + byte]));
    let [page, size] = [ROOT, ROOT + 8].map(long);
    let entries: Vec<Entry> =
        file[page as usize..][..size as usize].chunks_exact(Entry::SIZE).map(Entry::parse).collect();
    let first = |is: fn(&Entry) -> bool| {
        let index = entries.iter().position(is).unwrap();
        (page as usize + index * Entry::SIZE, entries[index])
    };
    let (page_at, to_page) = first(|entry| entry.points == -1);
    let (node_at, node) = first(|entry| entry.points > 0);
    let with = |at: usize, bytes: &[u8]| {
        let mut damaged = file.clone();
        damaged[at..at + bytes.len()].copy_from_slice(bytes);
        damaged
    };
    let end = file.len() as u64;
    let entry = |at: usize, entry: Entry| with(at, &entry.to_bytes());
    let deep = Key { level: 40, ..node.key };
    let cases = [
        (entry(page_at, Entry { offset: page, size: size as i32, ..to_page }), "named twice"),
        (entry(page_at, Entry { offset: end - 31, size: 32, ..to_page }), "a page of 32 bytes"),
        (entry(page_at, Entry { offset: u64::MAX, ..to_page }), "cannot be there"),
        (entry(page_at, Entry { size: 33, ..to_page }), "a page of 33 bytes"),
        (entry(page_at, Entry { size: -1, ..to_page }), "is no node"),
        (entry(node_at, Entry { points: -2, ..node }), "is no node"),
        (entry(node_at, Entry { size: 0, ..node }), "is no node"),
        (entry(node_at, Entry { key: deep, ..node }), "is no node"),
        (entry(node_at, Entry { offset: node.offset + 1, ..node }), "no node is the chunk"),
        (entry(node_at, Entry { points: node.points + 1, ..node }), "no node is the chunk"),
        (entry(node_at, Entry { points: 0, ..node }), "no node is the chunk"),
        (with(ROOT, &(end - 8).to_le_bytes()), "cannot be there"),
        (with(ROOT + 8, &u64::MAX.to_le_bytes()), "cannot be there"),
    ];
    for (damaged, expected) in cases {
        let failed = read_bytes("a", &damaged, &least(Some(1))).unwrap_err().to_string();
        assert!(
            failed.contains("its octree is damaged") && failed.contains(expected),
            "{expected}: {failed}"
        );
        let Loaded { cloud, report, .. } = read_bytes("a", &damaged, &least(None)).unwrap();
        assert_eq!(numbers(&cloud), (0..60).collect::<Vec<_>>(), "{expected}");
        let reported = report.details.iter().any(|(name, text)| name == "octree" && text.contains(expected));
        assert!(reported || expected == "no node is the chunk", "{expected}: {:?}", report.details);
    }
    // Pages that overlap are read once at most.
    let chain: Vec<u8> =
        entries.iter().flat_map(|_| Entry { offset: page + 32, ..to_page }.to_bytes()).collect();
    let failed = read_bytes("a", &with(page as usize, &chain), &least(Some(1))).unwrap_err().to_string();
    assert!(failed.contains("named twice"), "{failed}");
}

/// The nodes of the file, and the positions of its points by their numbers.
fn contents(file: &[u8]) -> (Octree, Vec<DVec3>) {
    let input = Input { name: "a", source: Source::of(file), folder: None };
    let octree = Octree::read(&Header::read(&input).unwrap(), &input.source).unwrap().unwrap();
    let Loaded { cloud, .. } = read_bytes("a", file, &least(None)).unwrap();
    let mut positions = vec![DVec3::NAN; cloud.len()];
    for (intensity, position) in cloud.scalar.iter().flatten().zip(&cloud.positions) {
        positions[(*intensity / 257.0) as usize] = cloud.origin + position.as_dvec3();
    }
    (octree, positions)
}

#[test]
fn nodes_outside_of_the_bounds_are_not_read() {
    let file = std::fs::read(path()).unwrap();
    let (octree, positions) = contents(&file);
    assert!(positions.iter().all(|position| position.is_finite()));
    // In one of the eight cells of the second level, not at its sides.
    let Info { centre, half_side, .. } = octree.info;
    let bounds = [centre - half_side, centre - 0.05 * half_side];
    let is_inside = |number: &u64| {
        let at = positions[*number as usize];
        at.cmpge(bounds[0]).all() && at.cmple(bounds[1]).all()
    };
    let inside: Vec<u64> = (0..60).filter(is_inside).collect();
    let within = |min_points| {
        let filter = Filter { bounds: Some(bounds), ..Default::default() };
        ReadOptions { filter, ..least(min_points) }
    };
    let Loaded { cloud, report, .. } = read_bytes("a", &file, &within(None)).unwrap();
    assert_eq!(numbers(&cloud), inside);
    let filtered = 60 - inside.len() as u64;
    assert_eq!((report.points, report.dropped.filtered, report.dropped.thinned), (60, filtered, 0));
    // Chunks without a place inside do not matter, whatever they are.
    let mut damaged = file.clone();
    let outside = octree.nodes.iter().filter(|node| !octree.info.touches(node.key, bounds, DVec3::ZERO));
    let outside: Vec<&Entry> = outside.collect();
    assert!(outside.len() > 10 && octree.nodes.len() - outside.len() > 2, "{}", outside.len());
    for node in outside {
        damaged[node.offset as usize..][..node.size as usize].fill(0xff);
    }
    let Loaded { cloud, .. } = read_bytes("a", &damaged, &within(None)).unwrap();
    assert_eq!(numbers(&cloud), inside);
    assert!(read_bytes("a", &damaged, &least(None)).is_err());
    // Levels are counted among the nodes inside: the root has 20 points, its children there fewer.
    let Loaded { cloud, report, .. } = read_bytes("a", &damaged, &within(Some(21))).unwrap();
    let expected: Vec<u64> = inside.iter().copied().filter(|point| point % 3 < 2).collect();
    assert_eq!((numbers(&cloud), report.dropped.total()), (expected.clone(), 60 - expected.len() as u64));
    assert!(expected.len() < inside.len() && report.dropped.thinned > 0);
}

#[test]
fn a_cube_that_does_not_hold_the_points_leaves_none_out() {
    let file = std::fs::read(path()).unwrap();
    let (octree, positions) = contents(&file);
    let bounds = [positions[0] - 1.0, positions[0] + 1.0];
    let filter = Filter { bounds: Some(bounds), ..Default::default() };
    let options = ReadOptions { filter, ..least(None) };
    let expected = numbers(&read_bytes("a", &file, &options).unwrap().cloud);
    assert!(expected.contains(&0));
    let info = octree.info;
    for wrong in [
        Info { centre: info.centre + DVec3::new(0.0, 0.0, 3.0 * info.half_side), ..info },
        Info { half_side: 0.1, ..info },
        Info { half_side: f64::INFINITY, ..info },
        Info { half_side: -info.half_side, ..info },
        Info { centre: DVec3::NAN, ..info },
    ] {
        let mut damaged = file.clone();
        damaged[ROOT - 40..][..Info::SIZE].copy_from_slice(&wrong.to_bytes());
        let Loaded { cloud, .. } = read_bytes("a", &damaged, &options).unwrap();
        assert_eq!(numbers(&cloud), expected, "{wrong:?}");
    }
}

#[test]
fn records_come_back_from_their_bytes() {
    let info = Info {
        centre: DVec3::new(1.0, -2.0, 3e6),
        half_side: 4.5,
        spacing: 0.25,
        root: [1 << 40, 64],
        gps_time: [-1e8, 1e9],
    };
    let bytes = info.to_bytes();
    assert_eq!((Info::parse(&bytes), bytes.len()), (Some(info), Info::SIZE));
    assert_eq!(Info::parse(&bytes[1..]), None);
    let key = Key { level: 3, cell: [7, 0, 5] };
    let entry = Entry { key, offset: 1 << 40 | 77, size: 1234, points: -1 };
    assert_eq!(Entry::parse(&entry.to_bytes()), entry);
}
