//! How far two values of a pixel may be apart.

use super::Value;
use super::slack::Slack;

/// Largest differences that pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tolerance {
    /// Of each linear channel and of α, absolute.
    pub colour: f64,
    /// Of each component of the unit normal, absolute.
    pub normal: f64,
    /// Of the depth, relative to it.
    pub depth_relative: f64,
    /// Rounding error of a unit vector's component in float32, for the conditioning of steep splats; 0 judges strictly.
    ///
    /// A plane seen at an angle θ turns rounding errors of its normal, its centre and the ray into depth errors 1 / cos θ as
    /// large, and so `√|V|` with its weight: no float32 renderer can know better. Where that exceeds the other margins the
    /// ε test is in doubt over that much depth, and the pixel's tolerance widens to the weighted mean of its splats'
    /// and by as much as cancelling normals amplify it.
    pub rounding: f64,
}

impl Tolerance {
    /// What float32 can hold: the default with a rounding of four half units in the last place.
    pub fn float32() -> Self {
        Self { rounding: 4.0 * 2f64.powi(-24), ..Self::default() }
    }
}

impl Default for Tolerance {
    fn default() -> Self {
        Self { colour: 2e-4, normal: 2e-4, depth_relative: 1e-5, rounding: 0.0 }
    }
}

/// One image of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Channel {
    /// Linear RGB, or whatever the shading shows.
    Colour,
    /// α, and with it coverage.
    Coverage,
    /// Eye-space distance.
    Depth,
    /// World-space normal.
    Normal,
}

/// Largest differences, in the units of [`Tolerance`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worst {
    /// Of colour and α.
    pub colour: f64,
    /// Of the normal.
    pub normal: f64,
    /// Of the depth, relative.
    pub depth: f64,
}

impl Worst {
    /// The greater of either.
    pub fn widen(&mut self, other: &Self) {
        // Not `f64::max`, which would pass over what is not a number.
        let max = |a: f64, b: f64| if b.is_nan() || a < b { b } else { a };
        self.colour = max(self.colour, other.colour);
        self.normal = max(self.normal, other.normal);
        self.depth = max(self.depth, other.depth);
    }
}

/// How two values of a pixel are told apart.
pub(super) struct Judge {
    /// Largest differences that pass.
    limit: Worst,
    /// The colour holds depths, which are compared as such.
    depth_shown: bool,
}

impl Judge {
    /// For a pixel that rounding may move by `slack`.
    pub fn new(tolerance: &Tolerance, slack: Slack, depth_shown: bool) -> Self {
        let gain = 1.0 + slack.turn;
        let limit = Worst {
            colour: gain * tolerance.colour.max(slack.attribute),
            normal: (gain * tolerance.normal.max(slack.attribute)).max(slack.summed),
            depth: tolerance.depth_relative.max(slack.depth),
        };
        Self { limit, depth_shown }
    }

    /// How far `a` is from `b`, the reference.
    pub fn differences(&self, a: &Value, b: &Value) -> Worst {
        let unit = if b.depth == 0.0 { 1.0 } else { b.depth.abs() };
        let mut worst = Worst {
            colour: largest(&a.colour[3..], &b.colour[3..]),
            normal: largest(&a.normal, &b.normal),
            depth: (a.depth - b.depth).abs() / unit,
        };
        let shown = largest(&a.colour[..3], &b.colour[..3]);
        match self.depth_shown && b.covered {
            true => worst.widen(&Worst { depth: shown / unit, ..Default::default() }),
            false => worst.widen(&Worst { colour: shown, ..Default::default() }),
        }
        worst
    }

    /// The largest difference in tolerances: passes up to 1.
    pub fn excess(&self, d: &Worst) -> f64 {
        let parts = [d.colour / self.limit.colour, d.normal / self.limit.normal, d.depth / self.limit.depth];
        parts.into_iter().fold(0.0, |a, b| if b.is_nan() || a < b { b } else { a })
    }

    /// The first image out of tolerance, and what both hold there.
    pub fn first_difference(&self, seen: &Value, own: &Value) -> (Channel, [f64; 4], [f64; 4]) {
        let d = self.differences(seen, own);
        let beyond = |difference: f64, limit: f64| difference.is_nan() || difference > limit;
        let first = |v: f64| [v, 0.0, 0.0, 0.0];
        let pad = |[x, y, z]: [f64; 3]| [x, y, z, 0.0];
        if seen.covered != own.covered || beyond((seen.colour[3] - own.colour[3]).abs(), self.limit.colour) {
            (Channel::Coverage, first(seen.colour[3]), first(own.colour[3]))
        } else if beyond(d.depth, self.limit.depth) {
            (Channel::Depth, first(seen.depth), first(own.depth))
        } else if beyond(d.normal, self.limit.normal) {
            (Channel::Normal, pad(seen.normal), pad(own.normal))
        } else {
            (Channel::Colour, seen.colour, own.colour)
        }
    }
}

/// The largest absolute difference; NaN if there is one.
fn largest(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, |a, b| if b.is_nan() || a < b { b } else { a })
}
