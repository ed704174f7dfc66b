//! Peak signal-to-noise ratio: `20 log₁₀(peak / RMSE)` with a peak of 1.
//!
//! Unit: decibels; more is better. 20 dB is an RMSE of a tenth of white, 40 dB of a hundredth; infinite for equal
//! pictures, below 0 where linear colours are off by more than white.

/// PSNR of a [root mean square error](super::rmse).
pub fn psnr(rmse: f64) -> f64 {
    -20.0 * rmse.log10()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values() {
        assert_eq!([1.0, 0.1, 0.0].map(psnr), [0.0, 20.0, f64::INFINITY]);
        // Published for 8 bits: one code everywhere is 48.13 dB.
        assert!((psnr(1.0 / 255.0) - 48.130_803_608_679_1).abs() < 1e-12);
        assert!(psnr(2.0) < 0.0);
    }
}
