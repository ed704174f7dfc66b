//! Structural similarity (Wang, Bovik, Sheikh, Simoncelli: *Image Quality Assessment: From Error Visibility to Structural Similarity*,
//! IEEE Transactions on Image Processing 13(4), 2004, equation 13).
//!
//! Computed on sRGB luma from 0 to 1 (L = 1) with the paper's window, 11×11 Gaussian of σ = 1.5 px, and constants K₁ =
//! 0.01, K₂ = 0.03, at full resolution. It is the mean over all windows inside the picture, as in the authors' program;
//! a picture less than 11 px wide or high has none.
//!
//! Range: −1 to 1, no unit; 1 for equal pictures, below 0 for inverted structure.

use rayon::prelude::*;

/// Side of the window, px.
pub const WINDOW: usize = 11;

const SIGMA: f64 = 1.5;
/// (K₁ L)².
const C1: f64 = 0.01 * 0.01;
/// (K₂ L)².
const C2: f64 = 0.03 * 0.03;

/// Weighted means in a window: a, b, a², b², ab.
type Moments = [f64; 5];

/// Mean over all windows of two luma images of equal size; `None` if no window fits.
pub fn ssim(picture: &[f64], truth: &[f64], size: [u32; 2]) -> Option<f64> {
    let [width, height] = size.map(|side| side as usize);
    let [columns, rows] = [width, height].map(|side| (side + 1).saturating_sub(WINDOW));
    if columns == 0 || rows == 0 {
        return None;
    }
    let weights = weights();
    let row = |y: usize| -> f64 {
        let means = column_means(&picture[y * width..], &truth[y * width..], width, &weights);
        means.windows(WINDOW).map(|window| similarity(sum(&weights, window))).sum()
    };
    // Summed in the order of the rows, so that the result does not depend on the number of threads.
    let rows_sums: Vec<f64> = (0..rows).into_par_iter().map(row).collect();
    Some(rows_sums.iter().sum::<f64>() / (columns * rows) as f64)
}

/// Vertical means of the first 11 rows of both images: the window is separable.
fn column_means(picture: &[f64], truth: &[f64], width: usize, weights: &[f64; WINDOW]) -> Vec<Moments> {
    let column = |x: usize| {
        let at = |k: usize| {
            let (a, b) = (picture[k * width + x], truth[k * width + x]);
            [a, b, a * a, b * b, a * b]
        };
        sum(weights, &std::array::from_fn::<_, WINDOW, _>(at))
    };
    (0..width).map(column).collect()
}

fn sum(weights: &[f64; WINDOW], moments: &[Moments]) -> Moments {
    let mut sum = [0.0; 5];
    for (weight, moments) in weights.iter().zip(moments) {
        sum.iter_mut().zip(moments).for_each(|(sum, moment)| *sum += weight * moment);
    }
    sum
}

/// Equation 13.
fn similarity([a, b, aa, bb, ab]: Moments) -> f64 {
    // Rounding must not make a variance negative.
    let (variance_a, variance_b, covariance) = ((aa - a * a).max(0.0), (bb - b * b).max(0.0), ab - a * b);
    (2.0 * a * b + C1) * (2.0 * covariance + C2) / ((a * a + b * b + C1) * (variance_a + variance_b + C2))
}

/// Weights of one row or column of the window; their sum is 1.
fn weights() -> [f64; WINDOW] {
    let gaussian: [f64; WINDOW] = std::array::from_fn(|i| {
        let x = i as f64 - (WINDOW / 2) as f64;
        (-x * x / (2.0 * SIGMA * SIGMA)).exp()
    });
    let sum: f64 = gaussian.iter().sum();
    gaussian.map(|weight| weight / sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [20, 17];

    /// A wave, and another that contains it; both within 0 and 1.
    fn waves() -> [Vec<f64>; 2] {
        let image = |f: &dyn Fn(f64, f64) -> f64| {
            let pixel = |i: u32| f(f64::from(i % SIZE[0]), f64::from(i / SIZE[0]));
            (0..SIZE[0] * SIZE[1]).map(pixel).collect::<Vec<_>>()
        };
        let wave = |x: f64, y: f64| 0.5 + 0.4 * (0.9 * x).sin() * (0.7 * y).cos();
        [image(&|x, y| 0.8 * wave(x, y) + 0.1 * (1.3 * x * y).cos().abs()), image(&wave)]
    }

    #[test]
    fn the_same_is_1_and_the_negative_is_below_0() {
        let [_, truth] = waves();
        assert!((ssim(&truth, &truth, SIZE).unwrap() - 1.0).abs() < 1e-12);
        let negative: Vec<_> = truth.iter().map(|value| 1.0 - value).collect();
        assert!(ssim(&negative, &truth, SIZE).unwrap() < -0.8);
    }

    #[test]
    fn constants_have_a_closed_form() {
        // Only luminance differs: (2ab + C₁) / (a² + b² + C₁).
        for (a, b) in [(0.0f64, 1.0f64), (0.25, 0.5), (0.9, 0.8)] {
            let expected = (2.0 * a * b + 1e-4) / (a * a + b * b + 1e-4);
            let found = ssim(&[a; 340], &[b; 340], SIZE).unwrap();
            assert!((found - expected).abs() < 1e-12, "{a} {b}: {found}");
        }
    }

    #[test]
    fn structure_is_as_computed_elsewhere() {
        // Computed with numpy, by the whole 11×11 window at once.
        let [picture, truth] = waves();
        let found = ssim(&picture, &truth, SIZE).unwrap();
        assert!((found - 0.961_945_604_446_315).abs() < 1e-12, "{found}");
    }

    #[test]
    fn a_picture_without_a_window_has_none() {
        assert_eq!(ssim(&[0.0; 110], &[0.0; 110], [10, 11]), None);
        assert_eq!(ssim(&[0.0; 110], &[0.0; 110], [11, 10]), None);
        assert_eq!(ssim(&[0.0; 121], &[0.0; 121], [11, 11]), Some(1.0));
    }
}
