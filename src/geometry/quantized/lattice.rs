//! Lattices of clusters.

use super::codes::{half, half_value};
use crate::geometry::Surfels;
use glam::Vec3;

/// Lattice of a cluster's positions: multiples of a power of two. Positions are rounded down to it, so that they stay in their cells of levels of detail,
/// whose sides are powers of two.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lattice {
    /// The corner, a multiple of the step.
    pub low: Vec3,
    pub step: f32,
}

/// Most steps along a side.
const SIDE: f32 = 32_766.0;
/// The bits of a coordinate; one more is left.
pub const COORDINATE: u16 = 0x7fff;
/// Largest distance of a position from the exact one, in radii.
const NEAR: f32 = 1.0 / 128.0;
/// Radii are at most so many steps, as half floats end at 65,504.
const RADIUS: f32 = 32_768.0;
/// Steps from the origin that floats count.
const COUNTED: f32 = 16_777_216.0;
/// Steps are powers of two in this range, so that no product is subnormal or infinite.
const STEPS: [f32; 2] = [1e-25, 1e20];

impl Lattice {
    /// The lattice of valid positions with radii other than 0; `None` if it is too coarse for some of them.
    pub fn of<'a>(surfels: impl Iterator<Item = (&'a Vec3, &'a f32)> + Clone) -> Option<Self> {
        let valid = surfels.filter(|(_, radius)| **radius != 0.0);
        let ends = valid
            .clone()
            .fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], (p, _)| [low.min(*p), high.max(*p)]);
        let [low, high] = if ends[0].is_finite() { ends } else { [Vec3::ZERO; 2] };
        let largest = valid.clone().map(|(_, radius)| radius.abs()).fold(0.0, f32::max);
        let far = low.abs().max(high.abs()).max_element();
        let least = ((high - low).max_element() / SIDE).max(largest / RADIUS).max(far / COUNTED);
        let step = power_of_two(least.max(STEPS[0]));
        if step > STEPS[1] {
            return None;
        }
        let lattice = Self { low: (low / step).floor() * step, step };
        let near = |(position, radius): (&Vec3, &f32)| {
            let stored = lattice.code(*position, *radius).map(|code| lattice.surfel(code).0);
            stored.is_some_and(|stored| stored.distance(*position) <= NEAR * radius.abs())
        };
        { valid }.all(near).then_some(lattice)
    }

    /// Code of a surfel; `None` for a radius of less than 2⁻¹⁴ steps.
    pub fn code(&self, position: Vec3, radius: f32) -> Option<[u16; 4]> {
        let steps = (position / self.step).floor() - self.low / self.step;
        let [x, y, z] = steps.to_array().map(|step| step as u16);
        Some([x, y, z, half(radius / self.step)?])
    }

    /// Position and radius of a code, whatever the other bits of the coordinates are: products and sums are exact.
    pub fn surfel(&self, [x, y, z, radius]: [u16; 4]) -> (Vec3, f32) {
        let steps = Vec3::from([x, y, z].map(|step| f32::from(step & COORDINATE)));
        (self.low + steps * self.step, half_value(radius) * self.step)
    }
}

/// The least power of two that is not below a normal positive value.
fn power_of_two(value: f32) -> f32 {
    const FRACTION: u32 = (1 << (f32::MANTISSA_DIGITS - 1)) - 1;
    f32::from_bits((value.to_bits() + FRACTION) & !FRACTION)
}

const _: () = assert!(Surfels::LARGEST < STEPS[1]);
