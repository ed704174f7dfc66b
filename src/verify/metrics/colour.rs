//! Colours for comparison: over a background, in linear light or encoded for a display.

use crate::geometry::srgb;
use crate::picture::Picture;
use rayon::prelude::*;

/// Default background.
pub const BLACK: [f32; 3] = [0.0; 3];

/// Rec. 709 weights of red, green and blue, which sRGB shares (IEC 61966-2-1; ITU-R BT.709).
const LUMA: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The linear colours of `picture` over `background`, with straight α: `α c + (1 − α) b` (Porter and Duff, *Compositing Digital
/// Images*, SIGGRAPH 1984).
pub fn over(picture: &Picture, background: [f32; 3]) -> Vec<[f64; 3]> {
    let pixel = |&[r, g, b, alpha]: &[f32; 4]| {
        let (colour, alpha) = ([r, g, b], f64::from(alpha));
        [0, 1, 2].map(|axis| alpha * f64::from(colour[axis]) + (1.0 - alpha) * f64::from(background[axis]))
    };
    picture.colour.par_iter().map(pixel).collect()
}

/// Linear colours clamped to 0–1 and sRGB-encoded, not yet rounded to codes.
pub fn encoded(linear: &[[f64; 3]]) -> Vec<[f64; 3]> {
    let channel = |value: f64| srgb::encode(value.clamp(0.0, 1.0));
    linear.par_iter().map(|pixel| pixel.map(channel)).collect()
}

/// Luma of sRGB-encoded colours, 0–1: the weighted sum of encoded values, as in video; it is not luminance.
pub fn luma(encoded: &[[f64; 3]]) -> Vec<f64> {
    encoded.par_iter().map(|pixel| (0..3).map(|axis| LUMA[axis] * pixel[axis]).sum()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_are_composited_encoded_and_weighed() {
        let colour = vec![[0.5, 1.0, 0.0, 0.5], [9.0, 9.0, 9.0, 0.0], [2.0, -1.0, 0.214_041, 1.0]];
        let picture = Picture { size: [3, 1], colour, ..Default::default() };
        assert_eq!(over(&picture, BLACK)[..2], [[0.25, 0.5, 0.0], [0.0; 3]]);
        let linear = over(&picture, [1.0, 0.0, 0.5]);
        assert_eq!(linear[..2], [[0.75, 0.5, 0.25], [1.0, 0.0, 0.5]]);
        let encoded = encoded(&linear);
        // Published: linear 0.214041 is half way between black and white.
        let expected = [1.0, 0.0, 0.5];
        assert!((0..3).all(|axis| (encoded[2][axis] - expected[axis]).abs() < 1e-6), "{encoded:?}");
        assert!((luma(&[[1.0, 0.0, 0.5]])[0] - 0.2487).abs() < 1e-15);
    }
}
