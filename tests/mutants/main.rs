//! Damaged files, five thousand PLY files and five hundred of each other format in the everyday run and a hundred thousand of each in all:
//! whatever is in them, the readers neither panic nor hang nor take much memory, and what they accept keeps its promises, as do the surfels
//! that become of it.

mod files;
mod made;
#[allow(dead_code, reason = "other tests use the rest")]
#[path = "../support/matrix.rs"]
mod matrix;
mod mutate;
#[path = "../support/skipping.rs"]
mod skipping;

use cap::Cap;
use matrix::if_whole;
use mutate::Random;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::{Duration, Instant};
use surfel::estimate::Estimate;
use surfel::formats::{self, Loaded, ReadOptions};
use surfel::geometry::{Clip, ClipLine, Cloud, Colours, Model, Surfels, View, Weights};

#[global_allocator]
static ALLOCATOR: Cap<std::alloc::System> = Cap::new(std::alloc::System, usize::MAX);

/// Number of mutants of a format; a twentieth of them unless all tests run, and a two-hundredth of other formats than PLY.
const MUTANTS: u64 = 100_000;

/// Most points of a cloud that is made to surfels.
const MOST_POINTS: usize = 2000;

/// Longest time for one file.
const PATIENCE: Duration = Duration::from_millis(500);

/// What all threads together may use beyond what was in use before a file was read, bytes.
const CAP: usize = 256 << 20;

/// What reading a file may allocate in all, freed or not, bytes: a few tables, and so much for each byte of it. The most are arrays
/// for text records of six bytes. The points of LAZ may take any number of bytes, so that [`CAP`] alone holds.
fn allowance(bytes: &[u8]) -> u64 {
    if bytes.starts_with(b"LASF") { CAP as u64 } else { (1 << 20) + 100 * bytes.len() as u64 }
}

/// No test of each format, as others must not allocate while [`examine`] counts.
#[test]
fn no_mutant_breaks_a_reader() {
    check_undamaged();
    let count = if_whole(MUTANTS, MUTANTS / 20);
    let loaded = examine_mutants("PLY", &files::all(), count);
    // Damage that is always found at once would test nothing but the header.
    assert!(loaded > count / 10 && loaded < count * 9 / 10, "{loaded}");
    let stored =
        [&["las"][..], &["laz"], &["copc.laz"], &["e57"], &["pcd"], &["xyz", "xyzn", "xyzrgb", "pts"]];
    let stored = stored.map(|extensions| (extensions[0], files::of_formats(extensions)));
    for (format, files) in stored.into_iter().chain(made::all()) {
        let count = if_whole(MUTANTS, MUTANTS / 200);
        let loaded = examine_mutants(format, &files, count);
        assert!(loaded > count / 20 && loaded < count * 99 / 100, "{format}: {loaded}");
    }
}

/// Reads mutants of a format's files; returns how many could be read.
fn examine_mutants(format: &str, files: &[Vec<u8>], count: u64) -> u64 {
    assert!(!files.is_empty() && files.iter().all(|file| !file.is_empty()));
    let mut loaded = 0;
    for seed in 0..count {
        let mutant = damaged(format, files, seed);
        match catch_unwind(AssertUnwindSafe(|| examine(format, &mutant))) {
            Ok(accepted) => loaded += u64::from(accepted),
            Err(_) => panic!("{format}, seed {seed}, {} bytes: {}", mutant.len(), mutant.escape_ascii()),
        }
    }
    println!("{loaded} of {count} mutants of {} {format} files were read", files.len());
    loaded
}

/// A damaged file. Most damage is behind checksums and compression, which would be all that it reaches.
fn damaged(format: &str, files: &[Vec<u8>], seed: u64) -> Vec<u8> {
    let mut random = Random::new(seed);
    match format {
        "spz" if seed.is_multiple_of(8) => {
            mutate::mutant(&files.iter().map(|file| made::pack(file)).collect::<Vec<_>>(), &mut random)
        }
        "spz" => made::pack(&mutate::mutant(files, &mut random)),
        _ => {
            let mut mutant = mutate::mutant(files, &mut random);
            if format == "e57" && !seed.is_multiple_of(8) {
                mutate::renew_checksums(&mut mutant);
            }
            mutant
        }
    }
}

/// Checks the files before they are damaged. No test of its own: others must not allocate while [`examine`] counts.
fn check_undamaged() {
    let own = files::own().into_iter().map(|bytes| ("PLY", bytes));
    let made =
        made::all().into_iter().flat_map(|(format, files)| files.into_iter().map(move |file| (format, file)));
    for (format, bytes) in own.chain(made) {
        let bytes = if format == "spz" { made::pack(&bytes) } else { bytes };
        let Loaded { cloud, report, .. } =
            read(format, &bytes).unwrap_or_else(|error| panic!("{format}: {error}"));
        check(&cloud, &report);
        assert_eq!(report.trailing, 0);
        draw(cloud);
    }
}

/// With a chosen scalar, if there is a property of one of the usual names.
fn read(format: &str, bytes: &[u8]) -> surfel::Result<Loaded> {
    let named = |name: &&str| bytes.windows(name.len()).any(|window| window == name.as_bytes());
    let scalar = ["radius\n", "tag\n"].iter().find(|name| named(name)).map(|name| name.trim_end().into());
    // Only their names tell what they are.
    let name = match format {
        "splat" => "mutant.splat",
        "stl" => "mutant.stl",
        _ => "mutant",
    };
    // The nodes of an octree are needed for its coarse levels alone.
    let min_points = (format == "copc.laz").then_some(1);
    formats::read_bytes(name, bytes, &ReadOptions { scalar, min_points, ..Default::default() })
}

/// Whether it can be read; panics if anything about it is wrong.
fn examine(format: &str, bytes: &[u8]) -> bool {
    ALLOCATOR.set_limit(ALLOCATOR.allocated() + CAP).unwrap();
    let (start, before) = (Instant::now(), ALLOCATOR.total_allocated());
    let result = read(format, bytes);
    let (time, allocated) = (start.elapsed(), ALLOCATOR.total_allocated() - before);
    ALLOCATOR.set_limit(usize::MAX).unwrap();
    assert!(allocated as u64 <= allowance(bytes), "{allocated} bytes allocated for {}", bytes.len());
    if time > PATIENCE {
        // The machine may have been busy with other work; the same file is not slow twice by chance.
        let again = Instant::now();
        drop(read(format, bytes));
        assert!(again.elapsed() <= PATIENCE, "{time:?}, and again {:?}", again.elapsed());
    }
    match result {
        Ok(Loaded { cloud, report, .. }) => {
            check(&cloud, &report);
            draw(cloud);
            true
        }
        Err(error) => {
            let text = error.to_string();
            assert!(text.starts_with("mutant") && text.lines().count() == 1, "{text:?}");
            false
        }
    }
}

/// What a cloud promises.
fn check(cloud: &Cloud, report: &formats::Report) {
    let count = cloud.len();
    assert!(count > 0 && count as u64 + report.dropped.total() == report.points);
    let lengths = [
        cloud.normals.as_ref().map(Vec::len),
        cloud.radii.as_ref().map(Vec::len),
        cloud.ellipses.as_ref().map(Vec::len),
        cloud.two_sided.as_ref().map(Vec::len),
        cloud.clips.as_ref().map(|clips| clips.of.len()),
        cloud.weights.as_ref().map(|weights| weights.of.len()),
        cloud.colours.as_ref().map(Colours::len),
        cloud.scalar.as_ref().map(Vec::len),
        cloud.tangents.as_ref().map(Vec::len),
    ];
    assert!(lengths.iter().flatten().all(|length| *length == count), "{lengths:?}");
    assert!(cloud.origin.is_finite() && cloud.positions.iter().all(|position| position.is_finite()));
    let unit = |n: &glam::Vec3| (n.length() - 1.0).abs() < 1e-5;
    assert!(cloud.normals.iter().flatten().all(|n| *n == glam::Vec3::ZERO || unit(n)));
    assert!(cloud.radii.iter().flatten().all(|radius| radius.is_finite() && *radius >= 0.0));
    let sound =
        |shape: &surfel::geometry::Ellipse| shape.aspect > 0.0 && shape.aspect <= 1.0 && unit(&shape.major);
    assert!(cloud.ellipses.iter().flatten().all(sound));
    let across = |(shape, n): (&surfel::geometry::Ellipse, &glam::Vec3)| shape.major.dot(*n).abs() < 1e-5;
    assert!(cloud.ellipses.iter().flatten().zip(cloud.normals.iter().flatten()).all(across), "{cloud:?}");
    assert!(cloud.clips.is_none() || cloud.normals.is_some());
    assert!(cloud.weights.is_none() || cloud.normals.is_some() && cloud.radii.is_some());
    cloud.weights.iter().for_each(|weights| check_weights(weights, count));
    (0..count)
        .filter_map(|i| Some((cloud.clips.as_ref()?.get(i)?, cloud.normals.as_ref()?[i])))
        .for_each(check_clip);
    if let Some(Colours::Linear(colours)) = &cloud.colours {
        assert!(colours.iter().flatten().all(|channel| channel.is_finite() && *channel >= 0.0));
    }
    let index = |corner: &u32| (*corner as usize) < count;
    assert!(cloud.triangles.iter().flatten().all(index), "a corner that is no point");
    assert!(cloud.ribbons.iter().chain(&cloud.tubes).flatten().all(index), "an end that is no point");
    let apart = |[a, b]: &[u32; 2]| cloud.positions[*a as usize] != cloud.positions[*b as usize];
    assert!(cloud.ribbons.iter().chain(&cloud.tubes).all(apart), "a segment of no length");
    assert_eq!(report.lines.understood, (cloud.ribbons.len() + cloud.tubes.len()) as u64);
    assert!(cloud.tangents.iter().flatten().all(|t| *t == glam::Vec3::ZERO || unit(t)));
    match cloud.view {
        View::Unknown => {}
        View::From(eye) => assert!(eye.is_finite()),
        View::Towards(direction) => assert!(unit(&direction)),
    }
}

fn check_clip((clip, normal): (&Clip, glam::Vec3)) {
    let sound = |line: &ClipLine| {
        let unit = (line.outward.length() - 1.0).abs() < 1e-5 && line.outward.dot(normal).abs() < 1e-5;
        unit && line.offset.is_finite()
    };
    assert!(sound(&clip.lines[0]) && (clip.lines[1] == ClipLine::NONE || sound(&clip.lines[1])), "{clip:?}");
    assert!(!clip.concave || clip.lines[1].is_some(), "{clip:?}");
}

/// A factor of each surfel, 0 where it has none; those at corners of some of the surfels, in order.
fn check_weights(weights: &Weights, count: usize) {
    assert!(
        weights.of.len() == count && weights.of.iter().all(|w| *w >= 0.0 && w.is_finite()),
        "{weights:?}"
    );
    let at_corners = weights.corners.iter().flat_map(|corners| corners.weights);
    assert!(at_corners.into_iter().all(|weight| weight > 0.0 && weight.is_finite()), "{weights:?}");
    assert!(weights.corners.windows(2).all(|pair| pair[0].surfel < pair[1].surfel), "{weights:?}");
    assert!(weights.corners.iter().all(|corners| (corners.surfel as usize) < count), "{weights:?}");
}

/// Makes surfels, if that is possible, and looks at what they promise.
fn draw(cloud: Cloud) {
    if cloud.len() > MOST_POINTS {
        return;
    }
    for elliptical in [false, true] {
        let how = Estimate { elliptical, ..Default::default() };
        match cloud.clone().into_surfels(&how, &()) {
            Ok((surfels, _)) => check_surfels(&surfels),
            Err(error) => {
                let text = error.to_string();
                assert!(!text.is_empty() && text.lines().count() == 1, "{text:?}");
            }
        }
    }
    if cloud.has_lines() {
        match cloud.into_model(false, &Estimate::default(), &()) {
            Ok((model, _)) => check_model(&model),
            Err(error) => {
                let text = error.to_string();
                assert!(!text.is_empty() && text.lines().count() == 1, "{text:?}");
            }
        }
    }
}

fn check_model(Model { surfels, primitives }: &Model) {
    check_surfels(surfels);
    primitives.check().unwrap();
    assert!(primitives.directions.iter().all(|d| (d.length() - 1.0).abs() < 1e-4), "{primitives:?}");
    let lines = || primitives.segments().flat_map(|(ends, _)| ends);
    let radius = |i: u32| primitives.radii[i as usize];
    assert!(lines().all(|i| radius(i) >= 0.0 && radius(i).is_finite()), "{primitives:?}");
}

fn check_surfels(surfels: &Surfels) {
    surfels.check().unwrap();
    let unit = |n: &glam::Vec3| (n.length() - 1.0).abs() < 1e-4;
    for ((position, normal), radius) in surfels.positions.iter().zip(&surfels.normals).zip(&surfels.radii) {
        assert!(position.is_finite(), "a position: {position}");
        assert!(unit(normal) || *normal == glam::Vec3::ZERO, "a normal: {normal}");
        assert!(*radius > 0.0 && radius.is_finite(), "a radius: {radius}");
    }
    for (ellipse, normal) in surfels.ellipses.iter().flatten().zip(&surfels.normals) {
        assert!(ellipse.aspect > 0.0 && ellipse.aspect <= 1.0 && unit(&ellipse.major), "{ellipse:?}");
        assert!(ellipse.major.dot(*normal).abs() < 1e-3, "{ellipse:?} on {normal}");
    }
    surfels.weights.iter().for_each(|weights| {
        check_weights(weights, surfels.len());
        assert!(weights.of.iter().all(|weight| *weight > 0.0), "{weights:?}");
    });
    let clips = |i: usize| Some((surfels.clips.as_ref()?.get(i)?, surfels.normals[i]));
    (0..surfels.len()).filter_map(clips).for_each(check_clip);
}
