//! Normalization weights at the corners of a surfel's square.
//!
//! Ren, Pfister, Zwicker 2002 take 1/Σw at each corner (section 7.2). At the end of a surface Σw approaches 0 there, so
//! 1/Σw at a corner is several times that at the centre, and bilinear values between the corners are far above 1/Σw
//! inside. The corners are therefore fitted to the normalized basis function that the weight represents (section 7.1):
//! `s r` to `r / Σw` over the whole square, by least squares.

use glam::{DMat4, DVec2, DVec4};

/// Regularization of each corner towards the weight at the centre, as a share of `Σ r²`: it determines corners without
/// samples near them.
const REGULARIZATION: f64 = 0.01;
/// Least weight at a corner, as a share of that at the centre: weights are above 0.
const LEAST: f64 = 0.1;

/// Least-squares fit of one square.
pub(super) struct CornerFit {
    centre: f64,
    matrix: DMat4,
    right: DVec4,
    total: f64,
}

impl CornerFit {
    /// A fit for a square whose weight at the centre is `centre`.
    pub fn new(centre: f64) -> Self {
        Self { centre, matrix: DMat4::ZERO, right: DVec4::ZERO, total: 0.0 }
    }

    /// Adds a sample at a position in the square, each coordinate from −1 to 1: the kernel there, and the target
    /// weight.
    pub fn add(&mut self, place: DVec2, kernel: f64, wanted: f64) {
        let share = bilinear(place);
        let square = kernel * kernel;
        self.matrix +=
            DMat4::from_cols_array_2d(&(share * square).to_array().map(|s| (share * s).to_array()));
        self.right += share * square * wanted;
        self.total += square;
    }

    /// The weights at −u −v, +u −v, −u +v, +u +v.
    pub fn corners(&self) -> [f64; 4] {
        let regularization = REGULARIZATION * self.total;
        if regularization <= 0.0 {
            return [self.centre; 4];
        }
        let matrix = self.matrix + DMat4::from_diagonal(DVec4::splat(regularization));
        let corners = matrix.inverse() * (self.right + regularization * self.centre);
        corners.max(DVec4::splat(LEAST * self.centre)).to_array()
    }
}

/// Bilinear weights of the corners at a position in the square.
fn bilinear(place: DVec2) -> DVec4 {
    let [low, high] = [0.5 - 0.5 * place, 0.5 + 0.5 * place];
    DVec4::new(low.x * low.y, high.x * low.y, low.x * high.y, high.x * high.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fits `wanted` at 7 × 7 positions, with a Gaussian that falls to e⁻¹ at the middles of the sides.
    fn fit(centre: f64, wanted: impl Fn(DVec2) -> Option<f64>) -> [f64; 4] {
        let mut fit = CornerFit::new(centre);
        let place = |i: u32| f64::from(i) / 3.0 - 1.0;
        for at in (0..49).map(|i| DVec2::new(place(i % 7), place(i / 7))) {
            wanted(at).into_iter().for_each(|weight| fit.add(at, (-at.length_squared()).exp(), weight));
        }
        fit.corners()
    }

    fn assert_near(found: [f64; 4], expected: DVec4) {
        assert!(
            (DVec4::from_array(found) - expected).abs().max_element() < 1e-12,
            "{found:?} for {expected}"
        );
    }

    #[test]
    fn what_is_bilinear_is_found_but_for_the_hold() {
        let corners = DVec4::new(0.2, 0.4, 0.3, 0.7);
        let found = fit(0.4, |at| Some(bilinear(at).dot(corners)));
        // Slopes and twist are the eigenvectors, because kernel and positions are even in x and in y; r² weighs u² by
        // m on average, and (uv)² by m².
        let each = [(0.0, 0.5), (1.0, 1.0), (2.0, 1.0), (3.0, 1.0)];
        let sums = each.map(|(i, twice): (f64, f64)| {
            let (u, weight) = (i / 3.0, twice * (-2.0 * i * i / 9.0).exp());
            DVec2::new(u * u * weight, weight)
        });
        let [square, all] = sums.into_iter().sum::<DVec2>().to_array();
        let m = square / all;
        let [slope, twist] = [m, m * m].map(|mean| 0.25 * mean / (0.25 * mean + REGULARIZATION));
        let (along, up, both) = (DVec4::new(-1.0, 1.0, -1.0, 1.0), DVec4::new(-1.0, -1.0, 1.0, 1.0), 0.05);
        let held = DVec4::splat(0.4) + slope * (0.15 * along + 0.1 * up) + twist * both * along * up;
        assert_near(found, held);
        assert_near(fit(0.4, |_| Some(0.4)), DVec4::splat(0.4));
    }

    #[test]
    fn corners_near_which_nothing_is_seen_follow_the_others_or_the_centre() {
        assert_eq!(fit(0.4, |_| None), [0.4; 4]);
        let half = fit(0.4, |at| (at.x <= 0.0).then_some(0.4 + 0.2 * at.y));
        assert!(half.iter().all(|weight| (0.15..=0.65).contains(weight)), "{half:?}");
        assert!(half[2] > half[0] + 0.2 && half[3] > half[1], "{half:?}");
    }

    #[test]
    fn a_weight_that_soars_at_the_rim_makes_none_below_zero_and_keeps_the_centre() {
        // 1/Σw beside the last row of a lattice.
        let wanted = |at: DVec2| 0.5 * (3.0 * at.x.max(-0.2)).exp();
        let found = fit(0.5, |at| Some(wanted(at)));
        assert!(found[0] >= 0.05 && found[0] < 0.5 && found[1] > 1.0, "{found:?}");
        let literal = [wanted(DVec2::NEG_X), wanted(DVec2::X)];
        assert!(found[0].midpoint(found[1]) < 0.5 * literal[0].midpoint(literal[1]), "{found:?} {literal:?}");
    }
}
