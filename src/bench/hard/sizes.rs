//! Pictures of odd sizes.

use super::case::{Case, View, ball};
use crate::error::Result;
use crate::geometry::Camera;
use crate::verify::scenes::random::Random;
use glam::DVec3;

/// Widths and heights, px, by ascending ratio.
const SIZES: [[u32; 2]; 11] = [
    [1, 640],
    [1, 257],
    [3, 130],
    [37, 53],
    [63, 65],
    [1, 1],
    [65, 63],
    [53, 37],
    [130, 3],
    [257, 1],
    [640, 1],
];

/// Sizes that are no powers of two.
pub fn case() -> Case {
    Case {
        name: "size",
        description: "A sphere in pictures whose sizes are not powers of two, down to a width and a height of one pixel.",
        parameter: "width over height",
        logarithmic: true,
        values: SIZES.map(ratio).to_vec(),
        view,
        half: false,
        float32_limit: |_, _| None,
    }
}

fn ratio([width, height]: [u32; 2]) -> f64 {
    f64::from(width) / f64::from(height)
}

fn view(value: f64) -> Result<View> {
    let nearest =
        |a: &[u32; 2], b: &[u32; 2]| (ratio(*a) - value).abs().total_cmp(&(ratio(*b) - value).abs());
    let size = SIZES.into_iter().min_by(nearest).unwrap_or([1, 1]);
    let surfels = ball(1500, &mut Random::new(8, 1));
    let eye = DVec3::new(2.1, 1.0, 2.6);
    // The longer side has the angle of view.
    let angle = 2.0 * (0.35 / ratio(size).max(1.0)).atan();
    let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, angle, ratio(size), 1e-3)?;
    let note = format!("{}x{} px", size[0], size[1]);
    Ok(View { size, note, ..View::new(surfels, camera) })
}
