//! Discs around the eye plane and around the near plane.

use super::case::{Case, View, look, push, wall};
use crate::error::Result;
use crate::geometry::Surfels;
use crate::verify::scenes::random::Random;
use glam::DVec3;
use std::f64::consts::TAU;

const RADIUS: f64 = 0.5;

/// Cases of both planes.
pub fn cases() -> [Case; 2] {
    let case = |name, description, parameter, values: &[f64], view| Case {
        name,
        description,
        parameter,
        logarithmic: false,
        values: values.to_vec(),
        view,
        half: false,
        float32_limit: |_, _| None,
    };
    [
        case(
            "eye-plane",
            "Tilted discs around the axis of view, in front of a wall, from behind the eye plane to far in front of it; at 1 they touch it.",
            "distance of the centres in front of the eye plane, in the discs' extents along z",
            &[
                -2.0, -1.0, -0.5, 0.0, 0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999, 1.00001, 1.0001, 1.001, 1.01,
                1.03, 1.1, 1.3, 2.0, 4.0,
            ],
            eye_plane,
        ),
        case(
            "near-plane",
            "The same discs around the near plane, which clips them pixel by pixel.",
            "distance of the centres behind the near plane, in the discs' extents along z",
            &[-2.0, -1.001, -1.0, -0.999, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 0.999, 1.0, 1.001, 2.0],
            near_plane,
        ),
    ]
}

/// A wall, and a ring of discs around the z axis with their centres at `at(reach)`; a disc extends `reach` along z from
/// its centre.
fn ring(at: impl Fn(f64) -> f64) -> Surfels {
    let (mut surfels, mut random) = (Surfels::default(), Random::new(2, 1));
    wall(&mut surfels, &mut random, 12, 9.0, DVec3::Z * 8.0);
    for i in 0..16 {
        let (sin, cos) = (TAU * (f64::from(i) + 0.3 * random.unit()) / 16.0).sin_cos();
        let lean = 0.5 + 0.5 * random.unit();
        let out = DVec3::new(cos, sin, 0.0);
        let normal = lean * out - (1.0 - lean * lean).sqrt() * DVec3::Z;
        let position = (0.7 + 0.2 * random.unit()) * out + DVec3::Z * at(RADIUS * lean);
        push(&mut surfels, &mut random, position, normal, RADIUS);
    }
    surfels
}

fn eye_plane(value: f64) -> Result<View> {
    let surfels = ring(|reach| value * reach);
    Ok(View::new(surfels, look(DVec3::ZERO, DVec3::Z, 90.0, 1e-3)?))
}

fn near_plane(value: f64) -> Result<View> {
    let surfels = ring(|reach| 1.5 + value * reach);
    Ok(View::new(surfels, look(DVec3::ZERO, DVec3::Z, 80.0, 1.5)?))
}
