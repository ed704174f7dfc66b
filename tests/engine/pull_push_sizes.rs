//! Pull–push of small pictures, whose discs are smaller than a pixel, against rays through the pixels' centres.

use crate::support::gpu::{assert_silent, device, render};
use crate::support::{if_whole, skipping};
use glam::DVec3;
use std::sync::Arc;
use surfel::bench::subject::Subject;
use surfel::geometry::{Camera, Extent};
use surfel::settings::methods::pull_push;
use surfel::verify::truth::{self, Filter, Options};
use surfel::vk::{Device, DeviceLimits};
use surfel::{RenderOptions, Settings};

/// Sides of pictures, px, and by how much the number of covered px may be off, of the exact one.
const BARS: [(u32, f64); 5] = [(512, 0.02), (256, 0.02), (128, 0.02), (64, 0.03), (32, 0.08)];
/// Of the dragon, whose gaps between its parts are narrower than a pixel of small pictures, so that points are on all sides of them.
const BARS_OF_GAPS: [(u32, f64); 5] = [(512, 0.02), (256, 0.02), (128, 0.02), (64, 0.07), (32, 0.16)];
/// Most px that are not covered although the rays of all eight neighbours meet the surface, too. The dragon has 43 more at 512², where vertices
/// of steep triangles face away and are culled.
const MOST_HOLES: [usize; 2] = [5, 48];

/// Covered px over those of the exact surface, and holes.
fn coverage(device: &Arc<Device>, subject: &Subject, side: u32) -> (f64, usize) {
    let extent = Extent::from(&subject.bounds());
    let camera = Camera::framing(&extent, DVec3::Y, 45f64.to_radians(), 1.0).unwrap();
    let settings = Settings { pixel_filter: 0.0, ..pull_push::METHOD.settings() };
    let options = Options { filter: Filter::Point, ..Default::default() };
    let size = [side; 2];
    let truth = truth::render(subject.surface().unwrap(), &camera, &settings, size, &options, &()).unwrap();
    let model = subject.model(1_000_000).unwrap();
    let made = render(device, &model, &camera, &settings, RenderOptions { size, ..Default::default() });
    let [made, exact] = [&made, &truth.picture]
        .map(|picture| -> Vec<bool> { picture.colour.iter().map(|pixel| pixel[3] > 0.0).collect() });
    let side = side as usize;
    let is_inner = |i: &usize| {
        let (x, y) = (i % side, i / side);
        let inside = 1..side - 1;
        inside.contains(&x)
            && inside.contains(&y)
            && (y - 1..=y + 1).all(|y| exact[y * side + x - 1..=y * side + x + 1].iter().all(|hit| *hit))
    };
    let holes = (0..exact.len()).filter(|i| !made[*i]).filter(is_inner).count();
    let count = |pixels: &[bool]| pixels.iter().filter(|covered| **covered).count() as f64;
    (count(&made) / count(&exact), holes)
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn small_pictures_are_whole() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let models = [
        ("scene:bumpy-sphere", BARS, MOST_HOLES[0]),
        ("stanford/bunny/bun_zipper.ply", BARS, MOST_HOLES[0]),
        ("stanford/dragon/dragon_vrip.ply", BARS_OF_GAPS, MOST_HOLES[1]),
    ];
    let mut failed = Vec::new();
    for (name, bars, most_holes) in &models[..if_whole(3, 1)] {
        let subject = match name.starts_with("scene:") {
            true => Subject::scene(name),
            false => match skipping::data(name) {
                Some(path) => Subject::scan(&path, None, &()),
                None => continue,
            },
        };
        let subject = subject.unwrap();
        for (side, most) in bars[if_whole(0, 2)..].iter().copied() {
            let (part, holes) = coverage(&device, &subject, side);
            let line =
                format!("{}, {side}²: {part:.4} of the exact px, {holes} holes", subject.surface_name());
            println!("{line}");
            if (part - 1.0).abs() > most || holes > *most_holes {
                failed.push(line);
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
    assert_silent(&device);
}
