//! Pass `filter`: convolves the lit picture with a Gaussian, and blends it with the background (zwicker2004 equation 3, after light).

use super::Frame;
use super::normalize::blended;
use crate::settings::{Alpha, Settings};
use rayon::prelude::*;

/// The frame with filtered colours, if the settings filter pixels.
pub(super) fn pass(settings: &Settings, frame: Frame) -> Frame {
    if settings.filter_radius() == 0 {
        return frame;
    }
    Frame { colour: filtered(settings, &frame.colour, frame.size), ..frame }
}

/// Filters a picture of straight linear colours and α, row by row from the top left, without background.
pub fn filtered(settings: &Settings, colours: &[[f64; 4]], size: [u32; 2]) -> Vec<[f64; 4]> {
    let premultiplied: Vec<_> = colours.iter().map(|&[r, g, b, a]| [a * r, a * g, a * b, a]).collect();
    let means = convolved(settings, &premultiplied, size);
    let pixel = |(mean, own): (&[f64; 4], &[f64; 4])| {
        let [r, g, b, a] = *mean;
        let alpha = if settings.drawn_alpha() == Alpha::Coverage { a } else { own[3] };
        over_background(settings, [r / a, g / a, b / a, alpha])
    };
    means.iter().zip(colours).map(pixel).collect()
}

/// A straight colour over the background; any colour if α is 0.
pub(super) fn over_background(settings: &Settings, [r, g, b, alpha]: [f64; 4]) -> [f64; 4] {
    let colour = if alpha > 0.0 { [r, g, b] } else { [0.0; 3] };
    blended(settings, colour.into(), alpha)
}

/// Straight colours times these factors; over the background by the last pass that changes them.
pub(super) fn darkened(
    settings: &Settings,
    colours: &[[f64; 4]],
    factors: impl IntoIterator<Item = f64>,
    is_last: bool,
) -> Vec<[f64; 4]> {
    let pixel = |(&[r, g, b, a], factor): (&[f64; 4], f64)| {
        let colour = [factor * r, factor * g, factor * b, a];
        if is_last { over_background(settings, colour) } else { colour }
    };
    colours.iter().zip(factors).map(pixel).collect()
}

/// Each value's mean over the neighbours within the picture, weighted by the Gaussian up to [`Settings::filter_radius`] in each direction.
pub(super) fn convolved<const N: usize>(
    settings: &Settings,
    values: &[[f64; N]],
    size: [u32; 2],
) -> Vec<[f64; N]> {
    let radius = i64::from(settings.filter_radius());
    if radius == 0 {
        return values.to_vec();
    }
    let [width, height] = size.map(i64::from);
    let exponent = -0.5 / f64::from(settings.pixel_filter);
    let mean = |i: usize| {
        let [x, y] = [i as i64 % width, i as i64 / width];
        let (mut sum, mut weights) = ([0.0; N], 0.0);
        for v in (y - radius).max(0)..=(y + radius).min(height - 1) {
            for u in (x - radius).max(0)..=(x + radius).min(width - 1) {
                let weight = (exponent * ((u - x).pow(2) + (v - y).pow(2)) as f64).exp();
                let value = &values[(v * width + u) as usize];
                sum.iter_mut().zip(value).for_each(|(sum, value)| *sum += weight * value);
                weights += weight;
            }
        }
        sum.map(|sum| sum / weights)
    };
    (0..values.len()).into_par_iter().map(mean).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(alpha: Alpha) -> Settings {
        Settings { alpha, pixel_filter: 0.75, background: None, ..Settings::default() }
    }

    /// A half plane, opaque red: columns below 8 of 16.
    fn edge() -> Vec<[f64; 4]> {
        (0..256).map(|i| if i % 16 < 8 { [1.0, 0.0, 0.0, 1.0] } else { [0.0; 4] }).collect()
    }

    #[test]
    fn an_edge_has_the_alpha_of_the_integral_of_the_gaussian() {
        let filtered = filtered(&settings(Alpha::Coverage), &edge(), [16, 16]);
        // Sums of exp(−k² / 1.5) over k from 0, 1, 2 … of all k.
        let weight = |k: i32| (-f64::from(k * k) / 1.5).exp();
        let all: f64 = (-3..=3).map(weight).sum();
        for (x, from) in [(7, -3..=0), (8, 1..=3), (9, 2..=3)] {
            let expected = from.map(weight).sum::<f64>() / all;
            let [red, .., alpha] = filtered[16 * 8 + x];
            assert!(
                (alpha - expected).abs() < 1e-12 && (red - 1.0).abs() < 1e-12,
                "{x}: {alpha}, {expected}"
            );
        }
    }

    #[test]
    fn a_mask_keeps_its_alpha_and_the_colours_of_its_own_pixels() {
        let mut picture = edge();
        picture[16 * 8 + 7] = [0.0, 1.0, 0.0, 1.0];
        let filtered = filtered(&settings(Alpha::Mask), &picture, [16, 16]);
        for (own, now) in picture.iter().zip(&filtered) {
            assert_eq!(own[3], now[3]);
            let total: f64 = now[..3].iter().sum();
            assert!((total - own[3]).abs() < 1e-12, "no colour comes from empty pixels: {now:?}");
        }
        assert!(filtered[16 * 8 + 6][1] > 0.05);
    }
}
