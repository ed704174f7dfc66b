//! Many splats on one pixel.

use super::case::{Case, View, look, push, signed};
use crate::error::Result;
use crate::geometry::Surfels;
use crate::settings::Precision;
use crate::verify::scenes::random::Random;
use glam::DVec3;

/// Height of a pixel at the distance of the surfels: 64 rows of a picture of height 2.
const PIXEL: f64 = 2.0 / 64.0;

/// Splats smaller than a pixel, and coincident splats.
pub fn cases() -> [Case; 2] {
    [
        Case {
            name: "sub-pixel",
            description: "A patch of 14² px of overlapping splats, so small that many have their centres in one pixel.",
            parameter: "splats per pixel",
            logarithmic: true,
            values: vec![1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0],
            view: sub_pixel,
            half: false,
            float32_limit: too_dense,
        },
        Case {
            name: "accumulator",
            description: "Coincident splats of 24 px and different colours, all summed in each pixel.",
            parameter: "coincident splats",
            logarithmic: true,
            values: (0..=12).step_by(2).map(|power| f64::from(1u32 << power)).collect(),
            view: accumulator,
            half: true,
            float32_limit: too_many,
        },
    ]
}

fn too_many(count: f64, precision: Precision) -> Option<&'static str> {
    match precision {
        Precision::Full if count <= 512.0 => None,
        Precision::Full => Some("every addition rounds, and the depth error grows by up to 2⁻²⁵ per splat"),
        Precision::Half => {
            Some("16-bit sums have 11 significant bits: a weight below 1/2048 of the sum is lost")
        }
    }
}

fn view(surfels: Surfels) -> Result<View> {
    let degrees = 2.0 * 0.2f64.atan().to_degrees();
    let camera = look(5.0 * DVec3::Z, DVec3::ZERO, degrees, 0.1)?;
    Ok(View { size: [64, 64], ..View::new(surfels, camera) })
}

fn too_dense(splats: f64, _: Precision) -> Option<&'static str> {
    (splats >= 1000.0)
        .then_some("too many splats end within rounding of a pixel's centre to try all combinations")
}

fn sub_pixel(density: f64) -> Result<View> {
    let (mut surfels, mut random) = (Surfels::default(), Random::new(6, 1));
    let spacing = PIXEL / density.sqrt();
    let side = (14.0 * PIXEL / spacing).round() as u32;
    for i in 0..side * side {
        let at =
            |k: u32, random: &mut Random| (f64::from(k) - 0.5 * f64::from(side) + random.unit()) * spacing;
        let position = DVec3::new(
            at(i % side, &mut random),
            at(i / side, &mut random),
            0.3 * spacing * signed(&mut random),
        );
        let normal = DVec3::new(0.2 * signed(&mut random), 0.2 * signed(&mut random), 1.0);
        push(&mut surfels, &mut random, position, normal, 1.5 * spacing);
    }
    // ε spans a pixel, so that splats many radii apart are blended.
    let mut view = view(surfels)?;
    view.settings.epsilon = (PIXEL / (1.5 * spacing)) as f32;
    Ok(view)
}

fn accumulator(count: f64) -> Result<View> {
    let (mut surfels, mut random) = (Surfels::default(), Random::new(6, 2));
    for _ in 0..count as u32 {
        push(&mut surfels, &mut random, DVec3::ZERO, DVec3::new(0.1, 0.2, 1.0), 12.03 * PIXEL);
    }
    view(surfels)
}
