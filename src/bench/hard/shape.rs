//! Very small, very large and very thin discs.

use super::case::{Case, View, decades, look, push, signed, vector};
use crate::error::Result;
use crate::geometry::{Ellipse, Surfels};
use crate::verify::scenes::random::Random;
use glam::DVec3;
use std::f64::consts::TAU;

/// Distance of the eye.
const DISTANCE: f64 = 4.0;

/// Discs scattered over a unit square around the origin.
pub fn cases() -> [Case; 2] {
    [
        Case {
            name: "radius",
            description: "400 discs, from points to walls that each fill the picture, tilted such that none reaches the eye plane.",
            parameter: "radius of the discs, radii of the object",
            logarithmic: true,
            values: decades(-6, 9),
            view: radius,
            half: false,
            float32_limit: |_, _| None,
        },
        Case {
            name: "anisotropy",
            description: "400 ellipses of similar length and random direction, ever thinner.",
            parameter: "length over width",
            logarithmic: true,
            values: vec![1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1e3, 3e3, 1e4],
            view: anisotropy,
            half: false,
            float32_limit: |_, _| None,
        },
    ]
}

/// 400 discs of which no part is nearer to the eye than half its distance.
fn strew(random: &mut Random, radius: f64) -> Surfels {
    let mut surfels = Surfels::default();
    let tilt = 0.25f64.min(0.25 * DISTANCE / radius);
    for _ in 0..400 {
        let position = vector(random) * DVec3::new(1.0, 1.0, 0.1 * radius.min(1.0));
        let normal = DVec3::Z + tilt * vector(random);
        let radius = radius * (1.0 + 0.1 * signed(random));
        push(&mut surfels, random, position, normal, radius);
    }
    surfels
}

fn radius(value: f64) -> Result<View> {
    let surfels = strew(&mut Random::new(5, 1), value);
    Ok(View::new(surfels, look(DISTANCE * DVec3::Z, DVec3::ZERO, 30.0, 1e-2)?))
}

fn anisotropy(value: f64) -> Result<View> {
    let mut random = Random::new(5, 2);
    let mut surfels = strew(&mut random, 0.4);
    let ellipse = |normal: &glam::Vec3| {
        let (s, t) = normal.as_dvec3().normalize().any_orthonormal_pair();
        let (sin, cos) = (TAU * random.unit()).sin_cos();
        Ellipse { major: (cos * s + sin * t).as_vec3(), aspect: (1.0 / value) as f32 }
    };
    surfels.ellipses = Some(surfels.normals.iter().map(ellipse).collect());
    Ok(View::new(surfels, look(DISTANCE * DVec3::Z, DVec3::ZERO, 30.0, 1e-2)?))
}
