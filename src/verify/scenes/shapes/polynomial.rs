//! Real roots of polynomials in an interval, all of them: between two adjacent roots of the derivative there is at most
//! one.

/// Greatest degree.
const DEGREE: usize = 4;

/// A small list on the stack, to avoid an allocation per ray.
#[derive(Clone, Copy, Debug, Default)]
pub struct Few {
    values: [f64; DEGREE + 1],
    count: usize,
}

impl Few {
    fn push(&mut self, value: f64) {
        self.values[self.count] = value;
        self.count += 1;
    }
}

impl std::ops::Deref for Few {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.values[..self.count]
    }
}

/// Value of the polynomial with these coefficients, the constant first.
fn value(coefficients: &[f64], t: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * t + c)
}

/// The polynomial's value and derivative.
fn value_and_slope(coefficients: &[f64], t: f64) -> (f64, f64) {
    coefficients.iter().rev().fold((0.0, 0.0), |(value, slope), c| (value * t + c, slope * t + value))
}

/// The roots between `low` and `high`, ascending, of a polynomial of degree 4 at most. An extremum within `touch` of 0
/// without a change of sign counts as one root.
pub fn roots(coefficients: &[f64], [low, high]: [f64; 2], touch: f64) -> Few {
    let mut found = Few::default();
    let degree = coefficients.len().saturating_sub(1);
    if degree == 0 {
        return found;
    }
    let mut derivative = [0.0; DEGREE];
    for (i, slot) in derivative[..degree].iter_mut().enumerate() {
        *slot = (i + 1) as f64 * coefficients[i + 1];
    }
    // An extremum that the derivative only touches is a saddle, which separates nothing.
    let extrema = roots(&derivative[..degree], [low, high], 0.0);
    let (mut a, mut at_a) = (low, value(coefficients, low));
    for (i, &b) in extrema.iter().chain(&[high]).enumerate() {
        let at_b = value(coefficients, b);
        if (at_a < 0.0) != (at_b < 0.0) {
            found.push(crossing(coefficients, [a, b], at_a < 0.0));
        } else if i < extrema.len() && at_b.abs() <= touch {
            found.push(b);
        }
        (a, at_a) = (b, at_b);
    }
    found
}

/// The root between `low`, where the sign is `negative`, and `high`, where it is not: Newton's method, with bisection
/// where a step leaves the bracket or does not halve the previous step.
fn crossing(coefficients: &[f64], [low, high]: [f64; 2], negative: bool) -> f64 {
    let (mut a, mut b) = (low, high);
    let enough = 2.0 * f64::EPSILON * low.abs().max(high.abs());
    let (mut t, mut last) = (0.5 * (a + b), b - a);
    while last > enough {
        let (value, slope) = value_and_slope(coefficients, t);
        *(if (value < 0.0) == negative { &mut a } else { &mut b }) = t;
        let newton = t - value / slope;
        let tame = newton >= a && newton <= b && (newton - t).abs() <= 0.5 * last;
        let next = if tame { newton } else { 0.5 * (a + b) };
        last = if tame { (next - t).abs() } else { 0.5 * (b - a) };
        t = next;
    }
    t
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
