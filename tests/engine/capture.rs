//! Normalization weights: captured ones are those of the sums that they stand for, and make of weights a partition of unity.

use crate::support::gpu::{assert_silent, device, render};
use glam::{DVec2, DVec3, Vec3};
use std::sync::Arc;
use surfel::capture::{Captured, VIEWS, capture, capture_region, overlaps};
use surfel::geometry::{Camera, Extent, Surfels, Weights};
use surfel::settings::methods::object_ewa;
use surfel::settings::splatting::{Filter, Footprint, Normalization, Splatting};
use surfel::settings::{Cull, Shading};
use surfel::verify::reference::{Expected, Tolerance};
use surfel::verify::scenes::{self, bumpy_sphere};
use surfel::vk::{Device, DeviceLimits};
use surfel::{Outputs, Picture, Rasterizer, RenderOptions, Settings};

/// How far captured weights are off, as a share. Views have variances of (8 px / F)² cos² 60° = 8 px² or more, F = √2. The least filter,
/// 0.71² / F² = 0.25 px², moves a sum by no more than its share of that, and linear interpolation by (1 px)² / 8 of a curvature of
/// 1 / variance.
const CAPTURED: f64 = (0.25 + 0.125) / 8.0;

/// A square lattice of `side` × `side` discs in the plane z = 0, of spacing 1 and the given radius.
fn lattice(side: u32, radius: f32) -> Surfels {
    let at = |i: u32| Vec3::new((i % side) as f32, (i / side) as f32, 0.0);
    let count = (side * side) as usize;
    Surfels {
        positions: (0..side * side).map(at).collect(),
        normals: vec![Vec3::Z; count],
        radii: vec![radius; count],
        ..Default::default()
    }
}

/// Object-space EWA with kernels that end on a circle, so that sums do not hang on how the squares lie.
fn round() -> Settings {
    let preset = object_ewa::METHOD.settings();
    Settings { splatting: Splatting { footprint: Footprint::Disc, ..preset.splatting }, ..preset }
}

fn captured(device: &Arc<Device>, surfels: &Surfels, settings: &Settings) -> (Surfels, Captured) {
    let (weights, found) = capture(device, surfels, settings, VIEWS, &()).unwrap();
    (Surfels { weights: Some(weights), ..surfels.clone() }, found)
}

/// Σw of a frame, at the pixels that show a surface.
fn sums(
    device: &Arc<Device>,
    surfels: &Surfels,
    camera: &Camera,
    how: Normalization,
    settings: &Settings,
    rasterizer: Rasterizer,
) -> Vec<f64> {
    let splatting = Splatting { normalization: how, ..settings.splatting };
    let settings = Settings { splatting, shading: Shading::Weight, ..settings.clone() };
    let options = RenderOptions { size: [256, 256], rasterizer: rasterizer.into(), ..Default::default() };
    let picture = render(device, surfels, camera, &settings, options);
    picture.colour.iter().filter(|pixel| pixel[3] > 0.0).map(|pixel| pixel[0].into()).collect()
}

/// Standard deviation by mean.
fn spread(values: &[f64]) -> f64 {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let square = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / values.len() as f64;
    square.sqrt() / mean
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[test]
fn a_lattice_has_the_lattice_sums_and_corners_at_its_edge() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let side = 20;
    let (surfels, found) = captured(&device, &lattice(side, 1.7), &round());
    let weights = surfels.weights.unwrap();
    assert_eq!((found.seen, found.computed), (400, 0));
    // ½ F² d² / r² = d² / 2.89 with F = √2; the neighbours at 1 and √2 are within 1.7, those at 2 are not, and neither is within a pixel of
    // the rim, where kernels end all at once.
    let [one, two] = [1.0, 2.0].map(|square: f64| (-square / 2.89).exp());
    let expected = 1.0 / (1.0 + 4.0 * one + 4.0 * two);
    let mut largest: f64 = 0.0;
    for i in 0..side * side {
        let [x, y] = [i % side, i / side].map(|v| v.min(side - 1 - v));
        let (weight, corners) = (f64::from(weights.of[i as usize]), weights.corners_of(i as usize));
        match x.min(y) {
            0 => assert!(corners.is_some() && weight > 1.2 * expected, "{x} {y}"),
            1 => {}
            _ => {
                largest = largest.max((weight / expected - 1.0).abs());
                assert_eq!(corners, None, "{x} {y}");
            }
        }
    }
    println!("weights within the lattice: {expected:.4}, off by {largest:.1e} at most; {found:?}");
    assert!(largest < CAPTURED, "{largest}");
    assert_silent(&device);
}

/// Σ of the kernels of an endless lattice at a place in it, `radius` below 2.
fn lattice_sum(at: DVec2, radius: f64) -> f64 {
    let offsets = (-3..=3).flat_map(|y| (-3..=3).map(move |x| DVec2::new(x.into(), y.into())));
    let from = offsets.map(|offset| at - at.floor() - offset);
    let inside = from.filter(|offset| offset.abs().max_element() <= radius);
    // ½ F² d² / r² with F = √2.
    inside.map(|offset| (-offset.length_squared() / (radius * radius)).exp()).sum()
}

#[test]
fn corners_make_borders_more_even_and_leave_the_inner_surface_alone() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let (side, radius, height) = (16, 1.5, 20.0);
    let preset = object_ewa::METHOD.settings();
    let settings = Settings { splatting: Splatting { filter: Filter::None, ..preset.splatting }, ..preset };
    let (surfels, found) = captured(&device, &lattice(side, radius), &settings);
    let middle = 0.5 * DVec3::new(f64::from(side - 1), f64::from(side - 1), 0.0);
    let camera =
        Camera::orthographic([middle + 9.0 * DVec3::Z, middle, DVec3::Y], height, 1.0, [1.0, 20.0]).unwrap();
    let size = 256;
    let scale = height / f64::from(size);
    let mut alike = surfels.clone();
    alike.weights.as_mut().unwrap().corners.clear();
    let mut same = surfels.clone();
    let within = 1.0 / lattice_sum(DVec2::ZERO, radius.into());
    same.weights = Some(Weights { of: vec![within as f32; surfels.len()], corners: Vec::new() });
    let rms = [&same, &alike, &surfels].map(|surfels| {
        let splatting = Splatting { normalization: Normalization::Surfel, ..settings.splatting };
        let settings = Settings { splatting, shading: Shading::Weight, ..settings.clone() };
        let options = RenderOptions { size: [size; 2], ..Default::default() };
        let picture = render(&device, surfels, &camera, &settings, options);
        let (mut squares, mut count) = (0.0, 0);
        for (i, pixel) in (0..).zip(&picture.colour).filter(|(_, pixel)| pixel[3] > 0.0) {
            let offset = DVec2::new(f64::from(i % size), f64::from(size - 1 - i / size)) + 0.5;
            let at = middle.truncate() + scale * offset - 0.5 * height;
            let sum = f64::from(pixel[0]);
            let inner = (at - middle.truncate()).abs().max_element()
                < 0.5 * f64::from(side - 1) - 2.0 * f64::from(radius);
            // Squares end in the middle between surfels: whether a pixel there is in is a matter of rounding.
            let edge = (at - at.floor() - 0.5).abs().min_element() < scale;
            if inner && !edge {
                let expected = lattice_sum(at, radius.into()) * within;
                assert!((sum / expected - 1.0).abs() < CAPTURED, "{at}: {sum} for {expected}");
            }
            if !inner {
                squares += (sum - 1.0f64).powi(2);
                count += 1;
            }
        }
        (squares / f64::from(count)).sqrt()
    });
    println!(
        "off 1 at the border, rms: with one weight for all, one a surfel, one a corner: {rms:.3?}; {found:?}"
    );
    // A surfel's own weight knows that there are fewer neighbours, its corners on which side: each has to show.
    assert!(rms[1] < 0.9 * rms[0] && rms[2] < 0.5 * rms[0] && rms[2] < 0.6 * rms[1], "{rms:?}");
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn captured_weights_are_those_of_the_sums_over_the_neighbours() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let surfels = bumpy_sphere::sample(20_000, 1);
    for (name, settings) in [("discs", round()), ("squares", object_ewa::METHOD.settings())] {
        let (captured, found) = captured(&device, &surfels, &settings);
        let all: Vec<u32> = (0..20_000).collect();
        let weights = captured.weights.unwrap();
        let pairs = overlaps(&surfels, &settings, &all).into_iter().zip(&weights.of);
        let off = median(pairs.map(|(sum, &weight)| (sum * f64::from(weight) - 1.0).abs()).collect());
        println!("{name}: median relative error {:.2} %, {found:?}", 100.0 * off);
        // A closed surface: everything is seen from somewhere.
        assert!(found.seen > 19_900 && off < CAPTURED, "{name}: {off} {found:?}");
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn weights_even_out_the_sums_by_either_rasterizer() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let irregular = scenes::open("scene:torus?points=20000&sampler=scanner").unwrap();
    for (name, surfels) in [
        ("lattice", lattice(40, 1.5)),
        ("bumpy sphere", bumpy_sphere::sample(20_000, 1)),
        ("scanned torus", irregular),
    ] {
        let preset = Settings { cull: Cull::None, ..object_ewa::METHOD.settings() };
        let (surfels, found) = captured(&device, &surfels, &preset);
        let camera = Camera::framing(&Extent::of(&surfels).unwrap(), DVec3::Y, 0.8, 1.0).unwrap();
        // What the paper's weights do that no picture is needed for: 1/Σw at every centre, exact, and the same all over the surfel.
        let all: Vec<u32> = (0..surfels.len() as u32).collect();
        let exact = overlaps(&surfels, &preset, &all).into_iter().map(|sum| ((1.0 / sum) as f32, None));
        let exact = Surfels { weights: Some(Weights::collect(exact)), ..surfels.clone() };
        for filter in [Filter::None, Filter::Object] {
            let settings = Settings { splatting: Splatting { filter, ..preset.splatting }, ..preset.clone() };
            for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
                let of = |(surfels, how)| sums(&device, surfels, &camera, how, &settings, rasterizer);
                let by_surfel = Normalization::Surfel;
                let sides = [(&surfels, Normalization::None), (&exact, by_surfel), (&surfels, by_surfel)];
                let sums = sides.map(of);
                let [none, exact, captured] = sums.each_ref().map(|sums| spread(sums));
                let [_, middle, found_middle] = sums.map(median);
                println!(
                    "{name} {rasterizer:?} {filter:?}: spread of Σw {none:.3}, exact weights {exact:.3}, captured {captured:.3}; \
                     median {middle:.3}, {found_middle:.3}; {found:?}"
                );
                // Weights that are off by so much add no more to the spread; where surfaces end, corners take some away.
                let bar = if name == "bumpy sphere" { exact + CAPTURED } else { exact };
                assert!(
                    exact < none && captured < none && captured < bar,
                    "{name}: {none} {exact} {captured}"
                );
                assert!((found_middle / middle - 1.0).abs() < CAPTURED, "{name}: {middle} {found_middle}");
            }
        }
    }
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn what_no_view_sees_is_computed() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut surfels = bumpy_sphere::sample(3_000, 1);
    surfels.colours = None;
    let inner = lattice(7, 1.5);
    surfels.positions.extend(inner.positions.iter().map(|p| 0.05 * (*p - 3.0)));
    surfels.normals.extend(&inner.normals);
    surfels.radii.extend(inner.radii.iter().map(|r| 0.05 * r));
    let (captured, found) = captured(&device, &surfels, &round());
    let middle = f64::from(captured.weights.unwrap().of[3_000 + 24]);
    let [one, two] = [1.0, 2.0].map(|square: f64| (-square / 2.25).exp());
    assert!(found.computed >= 49 && found.computed < 100, "{found:?}");
    assert!((middle * (1.0 + 4.0 * one + 4.0 * two) - 1.0).abs() < 1e-5, "{middle}");
    assert_silent(&device);
}

#[test]
fn a_region_is_captured_as_it_is_seen() {
    let Some(device) = device(DeviceLimits::default()) else { return };
    let mut surfels = lattice(40, 1.5);
    // From above a corner: a patch around (10, 10).
    let (eye, at) = (DVec3::new(10.0, 10.0, 12.0), DVec3::new(10.0, 10.0, 0.0));
    let camera = Camera::look_at(eye, at, DVec3::Y, 0.8, 1.0, 0.1).unwrap();
    let seen = capture_region(&device, &mut surfels, &camera, [256, 256], &round()).unwrap();
    let weights = surfels.weights.clone().unwrap();
    // Half the picture is 12 tan 0.4 = 5.07 wide.
    let inside = |p: &Vec3| (p.x - 10.0).abs() < 5.0 && (p.y - 10.0).abs() < 5.0;
    let count = surfels.positions.iter().filter(|p| inside(p)).count() as u64;
    assert!(seen >= count && seen <= 11 * 11, "{seen} of {count}");
    let [one, two] = [1.0, 2.0].map(|square: f64| (-square / 2.25).exp());
    let expected = 1.0 / (1.0 + 4.0 * one + 4.0 * two);
    for (p, &weight) in surfels.positions.iter().zip(&weights.of) {
        let near = (p.x - 10.0).abs() < 3.5 && (p.y - 10.0).abs() < 3.5;
        let far = (p.x - 10.0).abs() > 5.5 || (p.y - 10.0).abs() > 5.5;
        assert!(!near || (f64::from(weight) / expected - 1.0).abs() < 0.02, "{p}: {weight}");
        assert!(!far || weight == 1.0, "{p}: {weight}");
    }
    // Those captured before stay.
    let elsewhere =
        Camera { view: camera.view * glam::DMat4::from_translation(DVec3::new(-15.0, 0.0, 0.0)), ..camera };
    capture_region(&device, &mut surfels, &elsewhere, [256, 256], &round()).unwrap();
    let kept = surfels.weights.as_ref().unwrap();
    let place = |x: u32, y: u32| (y * 40 + x) as usize;
    assert_eq!(kept.of[place(9, 10)], weights.of[place(9, 10)]);
    assert!((f64::from(kept.of[place(25, 10)]) / expected - 1.0).abs() < 0.02);
    assert_silent(&device);
}

#[test]
#[ignore = "takes long: tools/test --all"]
fn every_window_has_its_own_weights() {
    let limits = DeviceLimits { max_storage_buffer_range: Some(1 << 20), ..Default::default() };
    let Some(device) = device(limits) else { return };
    let mut surfels = bumpy_sphere::sample(50_000, 1);
    surfels.sort_morton();
    let weight = |i: usize| 0.05 + 0.01 * (i % 31) as f32;
    let corners = |i: usize| i.is_multiple_of(5).then(|| [1, 2, 3, 4].map(|k| weight(k * i)));
    surfels.weights = Some(Weights::collect((0..50_000).map(|i| (weight(i), corners(i)))));
    let camera = Camera::framing(&Extent::of(&surfels).unwrap(), DVec3::Y, 0.8, 1.0).unwrap();
    let settings = object_ewa::progressive(true);
    let size = [128, 128];
    let expected = Expected::new(&surfels, &camera, size, &settings, &Tolerance::default()).unwrap();
    for rasterizer in [Rasterizer::Draw, Rasterizer::Compute] {
        let outputs = Outputs { normal: true, depth: true, id: false };
        let options = RenderOptions { size, outputs, rasterizer: rasterizer.into(), ..Default::default() };
        let judged = |surfels: &Surfels| {
            let picture: Picture = render(&device, surfels, &camera, &settings, options);
            expected.compare(&picture).unwrap()
        };
        assert!(judged(&surfels).passed(), "{rasterizer:?}: {:?}", judged(&surfels).failures.first());
        let mut turned = surfels.clone();
        turned.weights.as_mut().unwrap().corners.iter_mut().for_each(|corners| corners.weights.swap(0, 1));
        assert!(!judged(&turned).passed(), "{rasterizer:?}: other corners went unseen");
    }
    assert_silent(&device);
}
