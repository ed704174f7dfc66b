//! Bounds of the rounding error of a pixel's value while no decision flips.

use super::error_model::{Candidate, ErrorModel, Weight};
use glam::DVec3;

/// Bounds of a pixel's rounding error while no decision flips: weighted means over its splats. All but `normal_sum` are
/// 0 if [`super::Tolerance::rounding`] is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RoundingBound {
    /// Error of the depth, relative to the depth.
    pub depth: f64,
    /// Absolute error of the mean colour and of each component of the mean normal.
    pub attribute: f64,
    /// `Σw / |Σw n| − 1`: normals that cancel amplify an error of their normalized sum by 1 more than this.
    pub normal_gain: f64,
    /// Error of the unit normal by rounding of the weights and of their sum.
    pub normal_sum: f64,
}

impl RoundingBound {
    /// The larger of two bounds, one by one: a bound of mixed values.
    pub(super) fn max(self, other: Self) -> Self {
        Self {
            depth: self.depth.max(other.depth),
            attribute: self.attribute.max(other.attribute),
            normal_gain: self.normal_gain.max(other.normal_gain),
            normal_sum: self.normal_sum.max(other.normal_sum),
        }
    }
}

/// Half a unit in the last place of a float32 near 1.
const HALF_UNIT: f64 = 1.0 / (1 << 24) as f64;
/// Rounding error of a sum of a few floats, relative to the sum of their magnitudes, in half units in the last place.
const SUM: f64 = 4.0;

/// Sums over a pixel's splats from which its [`RoundingBound`] is computed.
#[derive(Clone, Copy, Default)]
pub(super) struct RoundingSums {
    weight: f64,
    normal: DVec3,
    normal_length: f64,
    weight_error: f64,
    half_ulps: f64,
    /// Weight of the splats in the mean depth: divided by the depth in perspective.
    depth_weight: f64,
    depth_error: f64,
    depth: f64,
    squared_depth: f64,
    squared_error: f64,
}

impl RoundingSums {
    /// Contribution of one splat.
    pub fn of(model: &ErrorModel, c: &Candidate, weight: &Weight) -> Self {
        let depth = c.depth;
        let depth_weight =
            if model.projector.depth.perspective { weight.value / depth } else { weight.value };
        let normal = weight.value * c.normal();
        Self {
            weight: weight.value,
            normal,
            normal_length: normal.length(),
            weight_error: weight.value * weight.error,
            half_ulps: weight.value * weight.half_ulps,
            depth_weight,
            depth_error: depth_weight * c.depth_error,
            depth: depth_weight * depth,
            squared_depth: depth_weight * depth * depth,
            squared_error: depth_weight * (weight.error + weight.shift_error).powi(2),
        }
    }

    /// The bounds.
    pub fn bound(&self) -> RoundingBound {
        let spread_of_normals = self.normal_length / self.normal.length();
        let half_ulps = HALF_UNIT * (SUM + self.half_ulps / self.weight);
        let normal_sum = if self.weight > 0.0 { half_ulps * spread_of_normals } else { 0.0 };
        if self.weight_error == 0.0 {
            return RoundingBound { normal_sum, ..Default::default() };
        }
        let mean = self.depth / self.depth_weight;
        let spread = (self.squared_depth / self.depth_weight - mean * mean).max(0.0).sqrt();
        // Weights with a relative error move a mean by at most that error times the standard deviation of the values
        // (Cauchy–Schwarz). Colours and normals are bounded by their range instead: 2.
        let depth =
            self.depth_error / self.depth_weight + (self.squared_error / self.depth_weight).sqrt() * spread;
        RoundingBound {
            depth: depth / mean.abs(),
            attribute: 2.0 * self.weight_error / self.weight,
            normal_gain: spread_of_normals - 1.0,
            normal_sum,
        }
    }
}

impl std::ops::AddAssign for RoundingSums {
    fn add_assign(&mut self, other: Self) {
        self.weight += other.weight;
        self.normal += other.normal;
        self.normal_length += other.normal_length;
        self.weight_error += other.weight_error;
        self.half_ulps += other.half_ulps;
        self.depth_weight += other.depth_weight;
        self.depth_error += other.depth_error;
        self.depth += other.depth;
        self.squared_depth += other.squared_depth;
        self.squared_error += other.squared_error;
    }
}
