//! Tolerances, and differences of two values of a pixel.

use super::Value;
use super::rounding::RoundingBound;

/// Largest differences that pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Of each linear channel and of α, absolute.
    pub colour: f64,
    /// Of each component of the unit normal, absolute.
    pub normal: f64,
    /// Of the depth, relative to it.
    pub depth_relative: f64,
    /// Rounding error of a unit vector's component in float32; 0 compares strictly.
    ///
    /// A plane seen at an angle θ amplifies rounding errors of its normal, its centre and the ray by 1 / cos θ in its
    /// depth, and so in `√|V|` and the weight: no float32 renderer can be more exact. Where that error exceeds the
    /// other tolerances, the ε test is ambiguous over that depth, and the pixel's tolerance grows to the weighted mean
    /// of the errors of its splats, amplified where normals cancel.
    pub rounding: f64,
}

impl Tolerance {
    /// Tolerance of float32: the default, with a rounding error of four half units in the last place.
    pub fn float32() -> Self {
        Self { rounding: 4.0 * 2f64.powi(-24), ..Self::default() }
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { colour: 2e-4, normal: 2e-4, depth_relative: 1e-5, rounding: 0.0 }
    }
}

/// A channel of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// Linear RGB, or the quantity of the shading.
    Colour,
    /// α, which implies coverage.
    Coverage,
    /// Eye-space distance.
    Depth,
    /// World-space normal.
    Normal,
}

/// Largest differences, in the units of [`Tolerance`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Differences {
    /// Of colour and α.
    pub colour: f64,
    /// Of the normal.
    pub normal: f64,
    /// Of the depth, relative.
    pub depth: f64,
}

impl Differences {
    /// Takes the maximum, channel by channel.
    pub fn take_max(&mut self, other: &Self) {
        // `f64::max` would drop NaN.
        let max = |a: f64, b: f64| if b.is_nan() || a < b { b } else { a };
        self.colour = max(self.colour, other.colour);
        self.normal = max(self.normal, other.normal);
        self.depth = max(self.depth, other.depth);
    }
}

/// The limits of one pixel.
pub(super) struct Limits {
    /// Largest differences that pass.
    limit: Differences,
    /// Whether the colour holds depths; these are compared by the limit of depths.
    depth_shown: bool,
}

impl Limits {
    /// The limits of a pixel whose rounding error is `bound`.
    pub fn new(tolerance: &Tolerance, bound: RoundingBound, depth_shown: bool) -> Self {
        let gain = 1.0 + bound.normal_gain;
        let limit = Differences {
            colour: gain * tolerance.colour.max(bound.attribute),
            normal: (gain * tolerance.normal.max(bound.attribute)).max(bound.normal_sum),
            depth: tolerance.depth_relative.max(bound.depth),
        };
        Self { limit, depth_shown }
    }

    /// Largest difference of a colour that passes.
    pub fn colour(&self) -> f64 {
        self.limit.colour
    }

    /// The differences of `a` from `b`, the reference.
    pub fn differences(&self, a: &Value, b: &Value) -> Differences {
        let unit = if b.depth == 0.0 { 1.0 } else { b.depth.abs() };
        let mut worst = Differences {
            colour: largest(&a.colour[3..], &b.colour[3..]),
            normal: largest(&a.normal, &b.normal),
            depth: (a.depth - b.depth).abs() / unit,
        };
        let colour = largest(&a.colour[..3], &b.colour[..3]);
        if self.depth_shown && b.covered {
            worst.take_max(&Differences { depth: colour / unit, ..Default::default() })
        } else {
            worst.take_max(&Differences { colour, ..Default::default() })
        }
        worst
    }

    /// The largest difference relative to its limit: passes up to 1.
    pub fn excess(&self, d: &Differences) -> f64 {
        let parts = [d.colour / self.limit.colour, d.normal / self.limit.normal, d.depth / self.limit.depth];
        parts.into_iter().fold(0.0, |a, b| if b.is_nan() || a < b { b } else { a })
    }

    /// The first channel out of tolerance, with both values.
    pub fn first_difference(&self, seen: &Value, own: &Value) -> (Channel, [f64; 4], [f64; 4]) {
        let d = self.differences(seen, own);
        let exceeds = |difference: f64, limit: f64| difference.is_nan() || difference > limit;
        let first = |v: f64| [v, 0.0, 0.0, 0.0];
        let pad = |[x, y, z]: [f64; 3]| [x, y, z, 0.0];
        if seen.covered != own.covered || exceeds((seen.colour[3] - own.colour[3]).abs(), self.limit.colour) {
            (Channel::Coverage, first(seen.colour[3]), first(own.colour[3]))
        } else if exceeds(d.depth, self.limit.depth) {
            (Channel::Depth, first(seen.depth), first(own.depth))
        } else if exceeds(d.normal, self.limit.normal) {
            (Channel::Normal, pad(seen.normal), pad(own.normal))
        } else {
            (Channel::Colour, seen.colour, own.colour)
        }
    }
}

/// The largest absolute difference; NaN if one of them is.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, |a, b| if b.is_nan() || a < b { b } else { a })
}
