//! Colour of a pixel on a textured surface.

use super::{Level, Reconstruction, Sample};
use glam::{DVec2, DVec3};

/// Colour at a pixel of the final level 0 that has a sample, from the mip level whose texels are as large as the pixel.
pub fn colour(frame: &Reconstruction, pushed: &Level, at: [i64; 2], sample: &Sample) -> DVec3 {
    let Some(image) = &frame.texture else { return sample.colour };
    let size = DVec2::from(image.level_size(0).map(f64::from));
    let steps = [[1, 0], [0, 1]].map(|step| size * difference(pushed, at, step, sample));
    let texels2 = steps[0].length_squared().max(steps[1].length_squared());
    image.sample(sample.coordinates, 0.5 * texels2.log2())
}

/// Change of the texture coordinates from one pixel to the next: from the neighbours on either side that belong to its
/// surface, or from one; 0 if there is none.
fn difference(pushed: &Level, [x, y]: [i64; 2], [dx, dy]: [i64; 2], own: &Sample) -> DVec2 {
    let way = |sign: i64| {
        let other = pushed.at([x + sign * dx, y + sign * dy])?;
        let one = other.near <= own.far && own.near <= other.far && other.tube == own.tube;
        one.then(|| sign as f64 * other.coordinate_offset(own))
    };
    match (way(-1), way(1)) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (Some(way), None) | (None, Some(way)) => way,
        (None, None) => DVec2::ZERO,
    }
}
