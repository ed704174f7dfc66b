//! Samples: positions, uniformity, distances, and absence of holes.

use super::super::random::Random;
use super::super::shapes::integrate;
use super::scenes;
use crate::geometry::{Colours, Surfels};
use crate::verify::scenes::{self, Surface};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Samplers of the whole surface.
const EVEN: [&str; 3] = ["jittered", "blue-noise", "grid"];

fn open(name: &str, rest: &str) -> Surfels {
    let depth = if name == "scene:tree" { "depth=1&" } else { "" };
    scenes::open(&format!("{name}?{depth}{rest}")).unwrap()
}

/// The same surface with stripes, whose colours are continuous.
fn surface(name: &str) -> Box<dyn Surface> {
    let depth = if name == "scene:tree" { "depth=1&" } else { "" };
    scenes::surface(&format!("{name}?{depth}albedo=stripes")).unwrap()
}

#[test]
fn samples_lie_on_the_surface_with_its_normals_and_colours() {
    for (name, _) in scenes() {
        let surface = surface(name);
        for sampler in ["jittered", "blue-noise", "grid", "scanner"] {
            let surfels = open(name, &format!("points=1500&albedo=stripes&sampler={sampler}"));
            assert_eq!(surfels.len(), 1500, "{name} {sampler}");
            let off = (0..surfels.len()).filter(|i| !is_on(&*surface, &surfels, *i)).count();
            // Rounding to f32 moves some across an edge of a face or of a square.
            assert!(off <= 15, "{name} {sampler}: {off} of 1500 are not on it");
        }
    }
}

/// Whether a ray along the normal hits the surface at surfel `i`, with the same normal and colour.
fn is_on(surface: &dyn Surface, surfels: &Surfels, i: usize) -> bool {
    let (p, n) = (surfels.positions[i].as_dvec3(), surfels.normals[i].as_dvec3());
    let Some(hit) = surface.trace(p + 1e-4 * n, -n) else { return false };
    let same = match &surfels.colours {
        Some(Colours::Linear(colours)) => {
            (0..3).all(|c| (f64::from(colours[i][c]) - hit.albedo[c]).abs() < 1e-3)
        }
        _ => false,
    };
    (hit.t - 1e-4).abs() < 1e-6 * (1.0 + p.length()) && hit.normal.dot(n) > 1.0 - 1e-5 && same
}

/// Pearson's χ² of the counts of 20 × 10 parts of equal area of a sphere, over its degrees of freedom: 1 for
/// independent points.
fn dispersion(surfels: &Surfels) -> f64 {
    let mut counts = [0u32; 200];
    for p in &surfels.positions {
        let part = f64::from(p.z).atan2(f64::from(p.x)).rem_euclid(TAU) / TAU;
        let (column, row) = ((20.0 * part) as usize, (5.0 * (1.0 + f64::from(p.y))) as usize);
        counts[column.min(19) + 20 * row.min(9)] += 1;
    }
    let expected = surfels.len() as f64 / 200.0;
    counts.iter().map(|count| (f64::from(*count) - expected).powi(2) / expected).sum::<f64>() / 199.0
}

#[test]
fn density_is_even() {
    for sampler in EVEN {
        let found = dispersion(&open("scene:sphere", &format!("points=20000&sampler={sampler}")));
        // More uniform than independent points.
        assert!(found < 0.5, "{sampler}: {found}");
    }
    let scanned = dispersion(&open("scene:sphere", "points=20000&sampler=scanner"));
    assert!(scanned > 5.0, "a scanner is uneven: {scanned}");
}

/// The centroid of the samples is that of the area, for every surface.
#[test]
fn every_part_gets_its_share() {
    for (name, surface) in scenes().filter(|(name, _)| *name != "scene:plane") {
        let (mut area, mut moment, mut square) = (0.0, DVec3::ZERO, 0.0);
        for piece in surface.pieces() {
            let size = piece.shape.cells();
            for i in 0..size[0] * size[1] {
                let integral = |f: &dyn Fn(DVec3) -> f64| {
                    let at = |uv: DVec2| {
                        let sample = piece.shape.at(uv);
                        sample.element * f(sample.point.position)
                    };
                    integrate([i % size[0], i / size[0]], size, at)
                };
                area += integral(&|_| 1.0);
                square += integral(&|p| p.length_squared());
                moment += DVec3::new(integral(&|p| p.x), integral(&|p| p.y), integral(&|p| p.z));
            }
        }
        let (centre, points) = (moment / area, 5000.0);
        let deviation = (square / area - centre.length_squared()).sqrt();
        for sampler in EVEN {
            let surfels = open(name, &format!("points=5000&sampler={sampler}"));
            let mean = surfels.positions.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / points;
            let error = (mean - centre).length() / (deviation / points.sqrt());
            assert!(error < 2.0, "{name} {sampler}: {error} standard errors");
        }
    }
}

/// Least distance between surfels whose normals are not opposite, in spacings.
fn least_distance(surfels: &Surfels, area: f64) -> f64 {
    let spacing = (area / surfels.len() as f64).sqrt();
    let nearest = |i: usize| {
        let (p, n) = (surfels.positions[i], surfels.normals[i]);
        let others = (0..i).filter(|j| surfels.normals[*j].dot(n) > 0.0);
        others.map(|j| f64::from(surfels.positions[j].distance(p))).fold(f64::INFINITY, f64::min)
    };
    (1..surfels.len()).into_par_iter().map(nearest).reduce(|| f64::INFINITY, f64::min) / spacing
}

#[test]
fn blue_noise_keeps_its_distance() {
    for name in ["scene:sphere", "scene:torus", "scene:part", "scene:relief", "scene:helix"] {
        let area = scenes::surface(name).unwrap().area();
        let least =
            |sampler: &str| least_distance(&open(name, &format!("points=4000&sampler={sampler}")), area);
        let (blue, jittered) = (least("blue-noise"), least("jittered"));
        assert!(blue > 0.6 && blue < 1.0, "{name}: {blue}");
        assert!(jittered < 0.2, "{name}: {jittered}");
    }
}

#[test]
fn the_plane_is_denser_near_its_middle_and_radii_follow() {
    for sampler in EVEN {
        let surfels = open("scene:plane", &format!("points=20000&sampler={sampler}"));
        // Equal numbers in rings of equal width in the metric ds / D: w from 1 to 10⁶ by factors of 10.
        let mut rings = [0; 6];
        for (p, r) in surfels.positions.iter().zip(&surfels.radii) {
            let w = 1.0 + f64::from(p.x).powi(2) + f64::from(p.z).powi(2);
            rings[(w.log10() as usize).min(5)] += 1;
            let ratio = f64::from(*r) / w.sqrt() / f64::from(surfels.radii[0]);
            let first = 1.0 + f64::from(surfels.positions[0].length_squared());
            assert!((ratio * first.sqrt() - 1.0).abs() < 1e-4, "{sampler}: {ratio}");
        }
        assert!(rings.iter().all(|count| (3200..3450).contains(count)), "{sampler}: {rings:?}");
    }
}

#[test]
fn seeds_repeat_and_differ() {
    for sampler in ["jittered", "blue-noise", "scanner"] {
        let made = |seed: u32| {
            open("scene:torus", &format!("points=3000&noise=0.2&outliers=0.1&sampler={sampler}&seed={seed}"))
        };
        assert_eq!(made(1), made(1), "{sampler}");
        assert_ne!(made(1).positions, made(2).positions, "{sampler}");
    }
}

#[test]
fn noise_is_along_the_normal_and_as_large_as_asked() {
    let spacing = (2.0 * TAU / 20_000.0).sqrt();
    for sampler in EVEN {
        let surfels = open("scene:sphere", &format!("points=20000&noise=0.5&sampler={sampler}"));
        let heights: Vec<_> =
            surfels.positions.iter().map(|p| (p.as_dvec3().length() - 1.0) / spacing).collect();
        let deviation = (heights.iter().map(|h| h * h).sum::<f64>() / 20_000.0).sqrt();
        assert!((deviation - 0.5).abs() < 0.01, "{sampler}: {deviation}");
        let turned =
            surfels.positions.iter().zip(&surfels.normals).any(|(p, n)| p.normalize().dot(*n) < 0.99999);
        assert!(!turned, "{sampler}");
    }
}

#[test]
fn a_scanner_sees_what_rays_meet_first_and_no_more() {
    let from = DVec3::from(scenes::camera("scene:part").unwrap().eye);
    let surface = scenes::surface("scene:part").unwrap();
    let surfels = open("scene:part", "points=3000&sampler=scanner&scans=1");
    let hidden = surfels.positions.iter().filter(|p| {
        let aim = p.as_dvec3() - from;
        surface.trace(from, aim).is_none_or(|hit| hit.t < 1.0 - 1e-5)
    });
    assert!(hidden.count() < 15);
    let all = open("scene:part", "points=3000&sampler=scanner&scans=1&outliers=0.2");
    let floating = all.positions.iter().filter(|p| {
        let aim = p.as_dvec3() - from;
        surface.trace(from, aim).is_some_and(|hit| hit.t > 1.001)
    });
    let count = floating.count();
    assert!((500..700).contains(&count), "{count} of 3000 float");
}

/// No ray of the recommended camera that hits the surface, and whose neighbours do, passes between the discs.
#[test]
fn discs_leave_no_hole() {
    const SIDE: i32 = 48;
    for (name, surface) in scenes() {
        let view = scenes::camera(name).unwrap();
        let camera = view.camera(1.0, &surface.bounds()).unwrap().view.inverse();
        let half = (0.5 * view.fov_y_deg.to_radians()).tan();
        let across = |i: i32| half * (2.0 * (f64::from(i) + 0.5) / f64::from(SIDE) - 1.0);
        let ray = |x: i32, y: i32| camera.transform_vector3(DVec3::new(across(x), across(y), 1.0));
        let eye = DVec3::from(view.eye);
        let meets = |x: i32, y: i32| surface.trace(eye, ray(x, y));
        for sampler in EVEN {
            let surfels = open(name, &format!("points=8000&sampler={sampler}"));
            let holes = (0..SIDE * SIDE).into_par_iter().filter(|i| {
                let (x, y) = (i % SIDE, i / SIDE);
                let around = [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)];
                let inner = around.iter().all(|(dx, dy)| meets(x + dx, y + dy).is_some());
                inner && !is_covered(&surfels, eye, ray(x, y))
            });
            assert_eq!(holes.count(), 0, "{name} {sampler}");
        }
    }
}

/// Whether a ray hits a disc.
fn is_covered(surfels: &Surfels, eye: DVec3, direction: DVec3) -> bool {
    (0..surfels.len()).any(|i| {
        let (p, n) = (surfels.positions[i].as_dvec3(), surfels.normals[i].as_dvec3());
        let t = (p - eye).dot(n) / direction.dot(n);
        let radius = f64::from(surfels.radii[i]);
        t > 0.0 && (eye + t * direction).distance_squared(p) <= radius * radius
    })
}

#[test]
fn few_points_are_as_many_as_asked_for() {
    let mut random = Random::new(6, 0);
    for (name, _) in scenes() {
        for sampler in ["jittered", "blue-noise", "grid", "scanner"] {
            let points = 1 + random.below(40);
            let surfels = open(name, &format!("points={points}&sampler={sampler}"));
            assert_eq!(surfels.len(), points, "{name} {sampler}");
            assert!(surfels.radii.iter().all(|r| *r > 0.0 && r.is_finite()), "{name} {sampler}");
        }
    }
}
