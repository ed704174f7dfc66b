//! Two surfaces close together.

use super::case::{Case, View, decades, look, push};
use crate::error::Result;
use crate::geometry::Surfels;
use crate::verify::scenes::random::Random;
use glam::DVec3;

const RADIUS: f64 = 0.1;

/// From almost coincident to far beyond ε.
pub fn case() -> Case {
    let near_threshold = [0.5, 0.9, 0.99, 0.999, 0.9999, 1.0001, 1.001, 1.01, 1.1, 2.0, 10.0];
    Case {
        name: "layers",
        description: "Two planes of discs, one behind the other: up to ε they are one surface, beyond it the nearer hides the other.",
        parameter: "distance between the planes, ε",
        logarithmic: true,
        values: decades(-8, -1).into_iter().chain(near_threshold).collect(),
        view,
        half: false,
        float32_limit: |_, _| None,
    }
}

fn view(distance: f64) -> Result<View> {
    let (mut surfels, mut random) = (Surfels::default(), Random::new(7, 1));
    for i in 0..2 * 24 * 24 {
        let [x, y] = [i % 24, i / 24 % 24].map(|k| (f64::from(k) - 11.5) * RADIUS / 1.5);
        let z = if i < 24 * 24 { 0.0 } else { -distance * RADIUS };
        push(&mut surfels, &mut random, DVec3::new(x, y, z), DVec3::Z, RADIUS);
    }
    Ok(View::new(surfels, look(DVec3::new(0.3, 0.2, 3.0), DVec3::ZERO, 32.0, 1e-2)?))
}
