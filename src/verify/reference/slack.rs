//! How far rounding alone, without any decision turning, may move the value of a pixel.

use super::margin::{Candidate, Margins};
use glam::DVec3;

/// How far rounding may move a pixel's value without any decision turning: the weighted mean over its splats. All but the last 0 where
/// [`super::Tolerance::rounding`] is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Slack {
    /// Of the depth, relative to it.
    pub depth: f64,
    /// Of the mean colour and the mean normal, absolute.
    pub attribute: f64,
    /// `Σw / |Σw n|`, less 1: the more the normals cancel, the more an error turns their normalised sum.
    pub turn: f64,
    /// What the rounding of the weights and of their sum does to the unit normal.
    pub summed: f64,
}

/// Half a unit in the last place of a float of 1.
const HALF_UNIT: f64 = 1.0 / (1 << 24) as f64;
/// Rounding error of a sum of a few floats, relative to the sum of their magnitudes, in half units in the last place.
const SUM: f64 = 4.0;

/// Sums over a pixel's splats that make its [`Slack`].
#[derive(Clone, Copy, Default)]
pub(super) struct Means {
    weight: f64,
    normal: DVec3,
    sway: f64,
    grain: f64,
    /// The weight that a splat has in the mean depth.
    pull: f64,
    wobble: f64,
    depth: f64,
    squared_depth: f64,
    squared_error: f64,
}

impl Means {
    /// What one splat contributes.
    pub fn of(margins: &Margins, c: &Candidate) -> Self {
        let pull = if margins.projector.depth.perspective { c.weight / c.depth } else { c.weight };
        Self {
            weight: c.weight,
            normal: c.weight * c.splat.normal,
            sway: c.weight * c.sway,
            grain: c.weight * c.grain,
            pull,
            wobble: pull * c.wobble,
            depth: pull * c.depth,
            squared_depth: pull * c.depth * c.depth,
            squared_error: pull * (c.sway + c.drift).powi(2),
        }
    }

    /// The means.
    pub fn slack(&self) -> Slack {
        let spread_of_normals = self.weight / self.normal.length();
        let grain = HALF_UNIT * (SUM + self.grain / self.weight);
        let summed = if self.weight > 0.0 { grain * spread_of_normals } else { 0.0 };
        if self.sway == 0.0 {
            return Slack { summed, ..Default::default() };
        }
        let mean = self.depth / self.pull;
        let spread = (self.squared_depth / self.pull - mean * mean).max(0.0).sqrt();
        // Weights that are wrong by some part move a mean by no more than that part of the spread (Cauchy and Schwarz). Of
        // colours and normals only the greatest spread is known: 2.
        let depth = self.wobble / self.pull + (self.squared_error / self.pull).sqrt() * spread;
        Slack {
            depth: depth / mean.abs(),
            attribute: 2.0 * self.sway / self.weight,
            turn: spread_of_normals - 1.0,
            summed,
        }
    }
}

impl std::ops::AddAssign for Means {
    fn add_assign(&mut self, other: Self) {
        self.weight += other.weight;
        self.normal += other.normal;
        self.sway += other.sway;
        self.grain += other.grain;
        self.pull += other.pull;
        self.wobble += other.wobble;
        self.depth += other.depth;
        self.squared_depth += other.squared_depth;
        self.squared_error += other.squared_error;
    }
}
