//! Parametrizations: derivatives, areas, and textures.

use super::super::random::Random;
use super::super::shapes::{Bumpy, Curve, Patch, Ribbon, Shape, Tube, integrate};
use super::{points, scenes};
use crate::verify::scenes;
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

#[test]
fn normals_and_elements_agree_with_differences() {
    let mut random = Random::new(1, 0);
    for (name, surface) in scenes() {
        for (piece, uv, sample) in points(&*surface, &mut random, 400) {
            let step = 1e-5;
            let across = |axis: DVec2| {
                let at = |uv| piece.shape.at(uv).point.position;
                (at(uv + step * axis) - at(uv - step * axis)) / (2.0 * step)
            };
            let (du, dv) = (across(DVec2::X), across(DVec2::Y));
            let cross = du.cross(dv);
            assert!((cross.length() - sample.element).abs() < 1e-5 * sample.element, "{name} {uv}");
            assert!((dv.length() - sample.along_v).abs() < 1e-5 * sample.along_v, "{name} {uv}");
            assert!((cross.normalize().dot(sample.point.normal).abs() - 1.0).abs() < 1e-6, "{name} {uv}");
            assert!((sample.point.normal.length() - 1.0).abs() < 1e-12, "{name} {uv}");
        }
    }
}

/// Closed surfaces: the divergence theorem gives the volume, which is negative if normals point inwards.
#[test]
fn normals_point_outwards() {
    let slab = 4.0 * 0.01;
    let volumes = [
        ("scene:sphere", 4.0 / 3.0 * PI),
        ("scene:torus", TAU * PI * 0.16),
        ("scene:part", 1.4 * (2.4 - 0.4 * 0.7 - 0.4 * 0.3 - PI / 16.0)),
        ("scene:slabs", 3.0 * slab),
    ];
    for (name, expected) in volumes {
        let surface = scenes::surface(name).unwrap();
        let volume: f64 = surface
            .pieces()
            .iter()
            .map(|piece| {
                let size = piece.shape.cells().map(|count| count.max(32));
                let flux = |uv: DVec2| {
                    let sample = piece.shape.at(uv);
                    sample.point.position.dot(sample.point.normal) * sample.element / 3.0
                };
                (0..size[0] * size[1]).map(|i| integrate([i % size[0], i / size[0]], size, flux)).sum::<f64>()
            })
            .sum();
        assert!((volume - expected).abs() < 2e-6 * expected, "{name}: {volume}, not {expected}");
    }
    let (_, helix) = scenes().find(|(name, _)| *name == "scene:helix").unwrap();
    let tube = helix.pieces()[0].shape.at(DVec2::new(0.0, 0.3)).point;
    // The tube starts near (0.8, −1, 0).
    assert!((tube.position - DVec3::new(0.8, -1.0, 0.0)).dot(tube.normal) > 0.19);
}

#[test]
fn areas_are_those_of_closed_forms() {
    for (name, surface) in scenes() {
        for piece in surface.pieces() {
            let size = piece.shape.cells();
            let element = |uv: DVec2| piece.shape.at(uv).element;
            let sum: f64 =
                (0..size[0] * size[1]).map(|i| integrate([i % size[0], i / size[0]], size, element)).sum();
            assert!((sum - piece.shape.area()).abs() < 1e-6 * sum, "{name}: {sum}");
        }
    }
    let area = |name: &str| scenes::surface(name).unwrap().area();
    assert!((area("scene:part") - part_area()).abs() < 1e-12, "{}", area("scene:part"));
    assert!((area("scene:slabs?gap=0.1&thickness=0.5&slabs=2") - 2.0 * (8.0 + 8.0 * 0.5)).abs() < 1e-12);
    let ends = [DVec3::ZERO, DVec3::new(0.0, 0.5, 0.0), DVec3::Y];
    let tube = Tube { curve: Curve::Bezier(ends), radii: [0.3, 0.1], reference: DVec3::X };
    assert!((Patch::new(tube, [8, 16]).area() - PI * 0.4 * 1f64.hypot(0.2)).abs() < 1e-12);
    let ribbon = Ribbon { curve: Curve::Bezier(ends), half: 0.5, ends: 1.0, twist: 4.0, reference: DVec3::X };
    let helicoid = 0.5 * 1f64.hypot(4.0 * 0.5) + (4.0f64 * 0.5).asinh() / 4.0;
    assert!((Patch::new(ribbon, [32, 8]).area() - helicoid).abs() < 1e-8);
    assert!((Bumpy.area() - 14.076).abs() < 5e-4);
}

/// By the shoelace formula and the outline's length.
fn part_area() -> f64 {
    use crate::verify::scenes::models::part::{BORE_RADIUS, DEPTH, PROFILE};
    let next = |i: usize| PROFILE[(i + 1) % PROFILE.len()];
    let pairs = (0..PROFILE.len()).map(|i| (PROFILE[i], next(i)));
    let front: f64 = pairs.clone().map(|(a, b)| 0.5 * (a[0] * b[1] - a[1] * b[0])).sum();
    let length: f64 = pairs.map(|(a, b)| (b[0] - a[0]).hypot(b[1] - a[1])).sum();
    2.0 * (front - PI * BORE_RADIUS.powi(2)) + 2.0 * DEPTH * (length + TAU * BORE_RADIUS)
}

#[test]
fn the_bumpy_sphere_has_its_old_colours() {
    let surface = scenes::surface("scene:bumpy-sphere").unwrap();
    let mut random = Random::new(4, 0);
    for (piece, _, sample) in points(&*surface, &mut random, 2000) {
        let code = scenes::bumpy_sphere::colour(sample.point.position);
        assert_eq!(piece.texture.at(&sample.point), scenes::texture::linear(code), "{:?}", sample.point);
    }
}
