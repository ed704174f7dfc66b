//! Fast exponential for the kernel.

use glam::Vec4;

/// Polynomial for 2^f, |f| ≤ ½, with a relative error of at most 2.6·10⁻⁶: the minimax polynomial of degree 4.
const POWERS: [f32; 5] = [0.999_999_3, 0.693_121_8, 0.240_247_45, 0.055_917_86, 0.009_570_102];

/// Addend that moves a float's integer part into the lowest bits: 1.5 · 2²³.
const ROUND: f32 = 12_582_912.0;

/// Largest argument whose result is a normal float.
const MOST: f32 = 174.0;

/// e^(−½ v) for v ≥ 0; constant beyond 174.
#[inline]
pub(super) fn exp_half(v: Vec4) -> Vec4 {
    let power = v.min(Vec4::splat(MOST)) * (-0.5 * std::f32::consts::LOG2_E);
    let rounded = power + ROUND;
    let f = power - (rounded - ROUND);
    let [c0, c1, c2, c3, c4] = POWERS;
    let mantissa = (((c4 * f + c3) * f + c2) * f + c1) * f + c0;
    // The integer becomes the exponent's bits; the other bits of ROUND overflow.
    let whole = rounded.to_array().map(|r| f32::from_bits((r.to_bits() << 23).wrapping_add(1f32.to_bits())));
    mantissa * Vec4::from_array(whole)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_exponential() {
        for i in 0..=40_000 {
            let v = 173.0 * (i as f32 / 40_000.0).powi(2);
            let [found, ..] = exp_half(Vec4::splat(v)).to_array();
            let exact = (-0.5 * f64::from(v)).exp();
            // The polynomial's error, and that of the rounded power.
            let bound = 3e-6 + 1e-7 * f64::from(v);
            assert!((f64::from(found) / exact - 1.0).abs() < bound, "{v}: {found} for {exact}");
        }
        assert!(exp_half(Vec4::splat(1e30)).x < 1e-37 && exp_half(Vec4::INFINITY).x > 0.0);
    }
}
