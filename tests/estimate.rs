//! Normals and radii that are estimated, against surfaces whose own are known.

mod support;

use glam::Vec3;
use std::collections::HashMap;
use support::mesh;
use support::sampling::Random;
use surfel::geometry::estimate::{Estimate, Estimated};
use surfel::geometry::{Cloud, Surfels};
use surfel::scenes::bumpy_sphere;

fn estimate(cloud: Cloud) -> (Surfels, Estimated) {
    cloud.into_surfels(&Estimate::default(), &()).unwrap()
}

/// How estimated normals differ from true ones.
#[derive(Debug)]
struct Errors {
    /// Angles between the lines, degrees.
    median: f32,
    p95: f32,
    /// Part of them on the true side.
    right: f64,
}

/// Compares the normals estimated from bare points with true ones (0 where there is none).
fn errors(positions: &[Vec3], truth: &[Vec3]) -> Errors {
    let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
    let truth: HashMap<_, _> = positions.iter().map(bits).zip(truth).collect();
    let (surfels, estimated) = estimate(Cloud { positions: positions.to_vec(), ..Default::default() });
    assert_eq!(estimated.normals_from_neighbours, positions.len() as u64);
    let pairs = surfels.positions.iter().zip(&surfels.normals).map(|(p, n)| (*n, *truth[&bits(p)]));
    let cosines: Vec<f32> =
        pairs.filter(|(_, truth)| *truth != Vec3::ZERO).map(|(n, truth)| n.dot(truth)).collect();
    let right = cosines.iter().filter(|cosine| **cosine > 0.0).count() as f64 / cosines.len() as f64;
    let mut angles: Vec<f32> =
        cosines.iter().map(|cosine| cosine.abs().min(1.0).acos().to_degrees()).collect();
    angles.sort_unstable_by(f32::total_cmp);
    Errors { median: angles[angles.len() / 2], p95: angles[angles.len() * 95 / 100], right }
}

#[test]
fn normals_of_a_noisy_sphere_are_right() {
    let truth = bumpy_sphere::sample(100_000, 1);
    let spacing = (bumpy_sphere::area() / 100_000.0).sqrt() as f32;
    let mut random = Random(7);
    let noisy: Vec<Vec3> = truth
        .positions
        .iter()
        .map(|p| *p + 0.1 * spacing * Vec3::from_array([0; 3].map(|_| random.normal() as f32)))
        .collect();
    let errors = errors(&noisy, &truth.normals);
    println!("{errors:?}");
    assert!(errors.median <= 2.0 && errors.p95 <= 8.0 && errors.right >= 0.995, "{errors:?}");
}

#[test]
fn normals_of_scans_are_those_of_their_meshes() {
    for name in ["stanford/bunny/bun_zipper.ply", "classic/igea.ply", "classic/feline_50k.ply"] {
        let Some(path) = mesh::data(name) else { return };
        let mesh = mesh::read(&path);
        let errors = errors(&mesh.positions, &mesh::normals(&mesh));
        println!("{name}: {errors:?}");
        assert!(errors.median <= 5.0 && errors.p95 <= 20.0 && errors.right >= 0.995, "{name}: {errors:?}");
    }
}
