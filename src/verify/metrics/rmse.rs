//! Root mean square error: `√(1/(3N) Σ (a − b)²)` over red, green and blue of all N pixels.
//!
//! Range: 0 (equal) and up; no unit, 1 is the difference of white from black. For linear colours it measures energy,
//! and values above white count in full; for sRGB-encoded colours, which end at 1, it is closer to perception.

/// RMSE of two lists of colours of equal length, which is not 0.
pub fn rmse(picture: &[[f64; 3]], truth: &[[f64; 3]]) -> f64 {
    let channels = picture.as_flattened().iter().zip(truth.as_flattened());
    let sum: f64 = channels.map(|(a, b)| (a - b) * (a - b)).sum();
    (sum / (3 * picture.len()) as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        let truth = [[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]];
        assert_eq!(rmse(&truth, &truth), 0.0);
        // A constant offset is its own RMSE.
        let offset = truth.map(|pixel| pixel.map(|value| value + 0.125));
        assert!((rmse(&offset, &truth) - 0.125).abs() < 1e-15);
        // One channel of six is off by 0.6: √(0.36 / 6).
        let mut one = truth;
        one[1][2] = 0.0;
        assert!((rmse(&one, &truth) - 0.06f64.sqrt()).abs() < 1e-15);
    }
}
