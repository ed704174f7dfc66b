//! Pass `occlusion`: the occluded part of the light from the hemisphere over each surface, from distances (bavoil2008, jimenez2016).

use super::Projector;
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;

/// Slices of the hemisphere through the ray, and samples on either side of it in each.
const SLICES: u32 = 2;
const STEPS: u32 = 8;
/// Weight of a surface that faces the eye.
const FACING: f64 = 1.0 / 256.0;
/// Differences of slopes up to which both sides of a pixel are of one surface.
const BEND: f64 = 0.125;
/// Outer part of the falloff in which a surface does not hide what is behind it.
const OUTER: f64 = 0.125;

/// What is known of 2 × 2 pixels: the values of one of them, if it shows a surface.
pub(super) struct Block {
    pub pixel: [i64; 2],
    pub depth: f64,
    /// Slope along x and y, in widths of a pixel per px.
    pub slope: DVec2,
    /// Occluded part of the light.
    pub occluded: f64,
}

/// A picture of distances, 0 or infinite without a surface.
pub(super) struct Depths<'a> {
    pub projector: &'a Projector,
    pub size: [i64; 2],
    pub depths: &'a [f64],
}

/// Radius within which surfaces occlude, px.
pub(super) fn radius(size: [i64; 2]) -> f32 {
    0.125 * size[0].min(size[1]) as f32
}

/// Columns and rows of blocks.
pub(super) fn grid(size: [i64; 2]) -> [i64; 2] {
    size.map(|side| (side + 1) / 2)
}

/// The blocks of a picture, row by row from the top left.
pub(super) fn pass(picture: &Depths<'_>) -> Vec<Option<Block>> {
    let [columns, rows] = grid(picture.size);
    (0..columns * rows).into_par_iter().map(|i| picture.block([i % columns, i / columns])).collect()
}

/// A point of a surface in eye space, and the frame of the rays around it.
struct Point {
    at: DVec3,
    /// Unit vectors.
    to_eye: DVec3,
    normal: DVec3,
    /// Steps to the next pixels at the point's distance.
    axes: [DVec3; 2],
    /// Width of a pixel.
    width: f64,
}

impl Depths<'_> {
    /// Distance of a pixel's surface.
    pub(super) fn depth(&self, [x, y]: [i64; 2]) -> Option<f64> {
        let [width, height] = self.size;
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        let depth = if inside { self.depths[(y * width + x) as usize] } else { 0.0 };
        (depth > 0.0 && depth.is_finite()).then_some(depth)
    }

    fn block(&self, block: [i64; 2]) -> Option<Block> {
        let [x, y] = block;
        let pixel = [(2 * x + (y & 1)).min(self.size[0] - 1), (2 * y + (x & 1)).min(self.size[1] - 1)];
        let depth = self.depth(pixel)?;
        let slope = DVec2::new(self.slope(pixel, [1, 0], depth), self.slope(pixel, [0, 1], depth));
        Some(Block { pixel, depth, slope, occluded: self.occluded(block, pixel, depth, slope) })
    }

    /// Slope along an axis: of both sides, each weighted by how straight it is, and of a surface that faces the eye.
    fn slope(&self, [x, y]: [i64; 2], [along_x, along_y]: [i64; 2], depth: f64) -> f64 {
        let base = i64::max(1, radius(self.size) as i64 / 16);
        let (mut sum, mut weights) = (0.0, FACING);
        for side in [-base, base] {
            let rise = |step: i64| {
                let other = self.depth([x + step * along_x, y + step * along_y])?;
                Some(self.projector.affine_rise(depth, other))
            };
            let (Some(near), Some(far)) = (rise(side), rise(2 * side)) else { continue };
            let bend = (far - 2.0 * near) / base as f64;
            let weight = (BEND * BEND + bend * bend).powi(-2);
            sum += weight * near / side as f64;
            weights += weight;
        }
        sum / weights
    }

    /// The occluded part of the light at a pixel.
    fn occluded(&self, [x, y]: [i64; 2], pixel: [i64; 2], depth: f64, slope: DVec2) -> f64 {
        let point = self.projector.point(pixel, depth, slope);
        let radius = radius(self.size);
        let first = f32::max(2.0, radius / 32.0);
        let angle = FRAC_PI_2 * (((x + y) & 3) << 2 | x & 3) as f64 / 16.0;
        let jitter = (((y - x) & 3) as f32 + 0.5) / 4.0;
        let first_along = DVec2::from_angle(angle).as_vec2();
        let side = |slice: u32, side: i64| {
            let along = if slice == 0 { first_along } else { first_along.perp() };
            let samples = (0..STEPS).filter_map(|i| {
                // The shader's arithmetic: rounding decides which pixel is read.
                let part = (i as f32 + jitter) / STEPS as f32;
                let distance = first + (radius - first) * part * part;
                let step = (along * distance + 0.5).floor().as_i64vec2();
                let other = [pixel[0] + side * step.x, pixel[1] + side * step.y];
                Some(self.projector.eye_point(other, self.depth(other)?) - point.at)
            });
            point.occluded(along.into(), side as f64, radius.into(), samples)
        };
        let sum: f64 = (0..SLICES).map(|slice| side(slice, -1) + side(slice, 1)).sum();
        sum / f64::from(SLICES)
    }
}

impl Point {
    /// The part of the light that samples on one side of a slice occlude; the offsets to them from near to far.
    fn occluded(&self, along: DVec2, side: f64, radius: f64, samples: impl Iterator<Item = DVec3>) -> f64 {
        let flat = |v: DVec3| v - v.dot(self.to_eye) * self.to_eye;
        let [x, y] = self.axes.map(flat);
        let across = along.x * x + along.y * y;
        // How fast the slice turns around the ray as its direction on the screen does.
        let turn = x.cross(y).length() / across.length_squared();
        let across = across.normalize() * side;
        let plane_normal = across.cross(self.to_eye);
        let within = self.normal - self.normal.dot(plane_normal) * plane_normal;
        let lean = within.dot(across).atan2(within.dot(self.to_eye));
        // Between the ray and an angle from it (jimenez2016, equation 7).
        let visible =
            |angle: f64| 0.25 * (lean.cos() - (2.0 * angle - lean).cos() + 2.0 * angle * lean.sin());
        let tangent = across * lean.cos() - self.to_eye * lean.sin();
        let (mut occluded, mut horizon) = (0.0, 0.0);
        for offset in samples {
            // The sample moved into the slice, at its height over the tangent plane.
            let (high, aside) = (offset.dot(self.normal), offset.dot(across));
            let lift = (high - aside * within.dot(across)) / within.dot(self.to_eye);
            let moved = aside * across + lift * self.to_eye;
            let elevation = moved.dot(within).atan2(within.length() * moved.dot(tangent)).max(0.0);
            let whole = FRAC_PI_2 + lean;
            let below = within.length() * (visible(whole) - visible(whole - elevation));
            let falloff = (1.0 - (offset.length() / (radius * self.width)).powi(2)).max(0.0);
            let more = f64::max(0.0, below - horizon);
            occluded += falloff * more;
            horizon += (falloff / OUTER).min(1.0) * more;
        }
        turn * occluded
    }
}

impl Projector {
    /// How far a surface at distance `other` is in front of one at `depth`, in widths of a pixel there: affine on the screen for a plane.
    pub(super) fn affine_rise(&self, depth: f64, other: f64) -> f64 {
        (depth - other) / (self.pixel_width() * if self.depth.perspective { other } else { 1.0 })
    }

    /// The eye-space point at a distance on the ray of a pixel.
    fn eye_point(&self, [x, y]: [i64; 2], depth: f64) -> DVec3 {
        let at = DVec3::new(1.0, x as f64 + 0.5, y as f64 + 0.5);
        self.starts * at + depth * (self.steps * at)
    }

    /// The point of a pixel's surface of this slope.
    fn point(&self, pixel: [i64; 2], depth: f64, slope: DVec2) -> Point {
        let step = self.steps * DVec3::new(1.0, pixel[0] as f64 + 0.5, pixel[1] as f64 + 0.5);
        let width = self.pixel_width() * if self.depth.perspective { depth } else { 1.0 };
        let axes =
            [self.starts.y_axis + depth * self.steps.y_axis, self.starts.z_axis + depth * self.steps.z_axis];
        let [x, y] = [axes[0] - slope.x * width * step, axes[1] - slope.y * width * step];
        let (to_eye, normal) = (-step.normalize(), x.cross(y).normalize());
        let normal = if normal.dot(to_eye) < 0.0 { -normal } else { normal };
        Point { at: self.eye_point(pixel, depth), to_eye, normal, axes, width }
    }
}

#[cfg(test)]
mod tests;
