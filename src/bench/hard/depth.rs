//! Distances of many magnitudes in one picture.

use super::case::{Case, View, decades, look, push, signed, vector};
use crate::error::Result;
use crate::geometry::Surfels;
use crate::verify::scenes::random::Random;
use glam::DVec3;

/// Strips at 10⁻³ and beyond.
pub fn case() -> Case {
    Case {
        name: "depth-range",
        description: "Vertical strips of discs side by side, each ten times as far away as the previous one, from 0.001 on; their edges overlap.",
        parameter: "distance of the farthest strip",
        logarithmic: true,
        values: decades(-2, 9),
        view,
        half: false,
        float32_limit: |_, _| None,
    }
}

fn view(farthest: f64) -> Result<View> {
    let (mut surfels, mut random) = (Surfels::default(), Random::new(3, 1));
    let strips = farthest.log10().round() as i32 + 4;
    let step = 2.0 / (4.0 * f64::from(strips));
    for strip in 0..strips {
        let distance = 10f64.powi(strip - 3);
        for i in 0..6 * 40 {
            // The picture spans −1 to 1: four columns per strip, and one more on either side.
            let x = (f64::from(4 * strip + i % 6) - 0.5) * step - 1.0;
            let y = (f64::from(i / 6) + 0.5) / 20.0 - 1.0;
            let off = 0.1 * step * vector(&mut random);
            let position = distance * (DVec3::new(x, y, 1.0) + off);
            let normal = DVec3::Z + 0.1 * vector(&mut random);
            let radius = distance * (1.5 + 0.1 * signed(&mut random)) * step.max(0.05);
            push(&mut surfels, &mut random, position, normal, radius);
        }
    }
    Ok(View::new(surfels, look(DVec3::ZERO, DVec3::Z, 90.0, 1e-4)?))
}
