//! Roots of polynomials in an interval, none missed: between two neighbouring roots of the derivative there is at most one.

/// Value of the polynomial with these coefficients, the constant first.
fn value(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// The roots between `low` and `high`, ascending. Where the polynomial comes within `touch` of 0 without a change of sign, its extremum
/// counts as one root.
pub fn roots(coefficients: &[f64], [low, high]: [f64; 2], touch: f64) -> Vec<f64> {
    if coefficients.len() < 2 {
        return Vec::new();
    }
    let derivative: Vec<f64> = coefficients.iter().enumerate().skip(1).map(|(i, c)| i as f64 * c).collect();
    // An extremum that the derivative only touches is a saddle, which divides nothing.
    let mut ends = roots(&derivative, [low, high], 0.0);
    ends.insert(0, low);
    ends.push(high);
    let mut found: Vec<f64> = Vec::new();
    for pair in ends.windows(2) {
        let (at_a, at_b) = (value(coefficients, pair[0]), value(coefficients, pair[1]));
        if (at_a < 0.0) != (at_b < 0.0) {
            found.push(crossing(coefficients, pair[0], pair[1], at_a < 0.0));
        } else if pair[1] < high && at_b.abs() <= touch {
            found.push(pair[1]);
        }
    }
    found
}

/// The root between `low`, where the sign is `negative`, and `high`, where it is not, by the ITP method (Oliveira & Takahashi 2020):
/// never slower than bisection by more than a step.
fn crossing(coefficients: &[f64], low: f64, high: f64, negative: bool) -> f64 {
    let (mut a, mut b) = (low, high);
    let oriented = |t: f64| if negative { value(coefficients, t) } else { -value(coefficients, t) };
    let (mut at_a, mut at_b) = (oriented(a), oriented(b));
    let epsilon = 2.0 * f64::EPSILON * low.abs().max(high.abs());
    let (half, truncation) = (((b - a) / (2.0 * epsilon)).log2().ceil().max(0.0), 0.2 / (b - a));
    let mut radius = epsilon * (half + 1.0).exp2();
    while b - a > 2.0 * epsilon {
        let middle = 0.5 * (a + b);
        radius *= 0.5;
        let interpolated = (at_b * a - at_a * b) / (at_b - at_a);
        let side = (middle - interpolated).signum();
        let step = truncation * (b - a).powi(2);
        let truncated =
            if step <= (middle - interpolated).abs() { interpolated + side * step } else { middle };
        let reach = (radius - 0.5 * (b - a)).max(0.0);
        let t = if (truncated - middle).abs() <= reach { truncated } else { middle - side * reach };
        // Rounding may put the estimate on an end, which would not move.
        let t = if t > a && t < b { t } else { middle };
        if t <= a || t >= b {
            break;
        }
        let at_t = oriented(t);
        if at_t < 0.0 {
            (a, at_a) = (t, at_t);
        } else {
            (b, at_b) = (t, at_t);
        }
    }
    0.5 * (a + b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_of_products_are_found() {
        // (t + 1)(t − 0.5)(t − 0.5 − 10⁻⁶)(t − 2), expanded by convolution.
        let given = [-1.0, 0.5, 0.5 + 1e-6, 2.0];
        let product = given.iter().fold(vec![1.0], |p, root| {
            let shifted = std::iter::once(0.0).chain(p.iter().copied());
            let scaled = p.iter().map(|c| -root * c).chain(std::iter::once(0.0));
            shifted.zip(scaled).map(|(a, b)| a + b).collect()
        });
        let found = roots(&product, [-3.0, 3.0], 0.0);
        assert_eq!(found.len(), 4, "{found:?}");
        assert!(found.iter().zip(given).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?}");
        assert_eq!(roots(&product, [0.0, 0.6], 0.0).len(), 2);
    }

    #[test]
    fn a_double_root_counts_if_it_touches() {
        assert_eq!(roots(&[1e-16, 0.0, 1.0], [-1.0, 1.0], 1e-15).len(), 1);
        assert_eq!(roots(&[1e-14, 0.0, 1.0], [-1.0, 1.0], 1e-15).len(), 0);
        assert_eq!(roots(&[5.0], [-1.0, 1.0], 0.0).len(), 0);
    }
}
