//! ꟻLIP: the difference that a viewer perceives when flipping between two pictures (Andersson, Nilsson, Akenine-Möller,
//! Oskarsson, Åström, Fairchild: *FLIP: A Difference Evaluator for Alternating Images*, Proceedings of the ACM on
//! Computer Graphics and Interactive Techniques 3(2), High Performance Graphics 2020), computed by the authors' program
//! through the crate `nv-flip`.
//!
//! LDR-FLIP takes 8-bit sRGB, so a difference below half a code may be 0. The result is a map with one value per pixel
//! from 0 (equal) to 1 (blue against green), no unit; its mean is the number that the authors report.

use super::statistics::Sorted;
use crate::error::{Error, Result};
use crate::formats::image::Encoded;
use crate::geometry::ColourMap;
use nv_flip::FlipImageRgb8;

/// Default pixels per degree of visual angle: the authors' choice, a screen of 3840 px and 0.7 m at a distance of 0.7
/// m; they call it 67.
pub const PIXELS_PER_DEGREE: f32 = (3840.0 * std::f64::consts::PI / 180.0) as f32;

/// Range of pixels per degree: the filters span a few degrees, and their cost grows with the resolution.
pub const RANGE: [f32; 2] = [1.0, 1000.0];

/// The difference of each pixel.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Row by row from the top left, each 0 to 1.
    pub values: Vec<f32>,
}

/// Compares sRGB-encoded colours of two pictures of `size`.
///
/// # Errors
/// [`Error::Usage`] if `pixels_per_degree` is out of [`RANGE`], or the picture has more bytes than 32 bits can count.
pub fn flip(picture: &[[f64; 3]], truth: &[[f64; 3]], size: [u32; 2], pixels_per_degree: f32) -> Result<Map> {
    if !(RANGE[0]..=RANGE[1]).contains(&pixels_per_degree) {
        let [min, max] = RANGE;
        return Err(Error::Usage(format!(
            "FLIP at {pixels_per_degree} pixels per degree: give a number from {min} to {max}"
        )));
    }
    let [width, height] = size;
    if u64::from(width) * u64::from(height) * 3 > u32::MAX.into() {
        return Err(Error::Usage(format!("FLIP of {width}x{height} px: at most 1431655765 pixels")));
    }
    let codes = |encoded: &[[f64; 3]]| {
        let bytes: Vec<u8> =
            encoded.as_flattened().iter().map(|value| (value * 255.0).round() as u8).collect();
        FlipImageRgb8::with_data(width, height, &bytes)
    };
    let map = nv_flip::flip(codes(truth), codes(picture), pixels_per_degree);
    Ok(Map { size, values: map.to_vec() })
}

impl Map {
    /// Mean over all pixels.
    pub fn mean(&self) -> f64 {
        Sorted::new(self.values.iter().map(|&value| value.into())).map_or(0.0, |values| values.mean())
    }

    /// The largest difference.
    pub fn max(&self) -> f64 {
        self.values.iter().fold(0.0, |max, &value| max.max(value.into()))
    }

    /// The map as a picture in the paper's colour map, magma: black is 0, pale yellow is 1.
    ///
    /// # Errors
    /// [`Error::Usage`] if the number of values does not match the size.
    pub fn coloured(&self) -> Result<Encoded> {
        let pixel = |&value: &f32| {
            let [r, g, b] = ColourMap::Magma.at(value.into());
            [r, g, b, 255]
        };
        Encoded::new(self.size, self.values.iter().map(pixel).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [48, 40];

    fn image(pixel: impl Fn(u32, u32) -> [f64; 3]) -> Vec<[f64; 3]> {
        (0..SIZE[0] * SIZE[1]).map(|i| pixel(i % SIZE[0], i / SIZE[0])).collect()
    }

    fn of(picture: &[[f64; 3]], truth: &[[f64; 3]]) -> Map {
        flip(picture, truth, SIZE, PIXELS_PER_DEGREE).unwrap()
    }

    fn stripes(offset: u32) -> Vec<[f64; 3]> {
        image(
            |x, y| {
                if ((x + offset) / 6).is_multiple_of(2) { [0.9, 0.4, f64::from(y) / 40.0] } else { [0.1; 3] }
            },
        )
    }

    #[test]
    fn the_same_is_0_and_a_shift_of_a_pixel_is_seen() {
        let same = of(&stripes(0), &stripes(0));
        assert_eq!((same.mean(), same.max()), (0.0, 0.0));
        let shifted = of(&stripes(1), &stripes(0));
        assert!(shifted.mean() > 0.1 && shifted.max() > 0.3, "{} {}", shifted.mean(), shifted.max());
        assert!(shifted.mean() < of(&stripes(3), &stripes(0)).mean());
    }

    #[test]
    fn structure_is_as_the_authors_compute_it() {
        // Values of the authors' Python package, flip-evaluator 1.7.
        for (offset, mean, max) in [(1, 0.410_390, 0.977_773), (3, 0.703_570, 0.979_717)] {
            let found = of(&stripes(offset), &stripes(0));
            assert!((found.mean() - mean).abs() < 2e-5, "{offset}: {}", found.mean());
            assert!((found.max() - max).abs() < 2e-5, "{offset}: {}", found.max());
        }
    }

    #[test]
    fn constants_have_a_closed_form() {
        // Published: the metric is scaled so that green and blue differ by 1.
        let [green, blue] = [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|colour| image(|_, _| colour));
        assert!((of(&green, &blue).mean() - 1.0).abs() < 1e-4);
        // By hand: black and white differ by 100 in L*, raised to 0.7; green and blue by 203.04, with a* and b*
        // multiplied by L*/100. Values above 0.4 of the latter's power map to 0.95 to 1.
        let (difference, largest) = (100f64.powf(0.7), 203.04f64.powf(0.7));
        let expected = 0.95 + 0.05 * (difference - 0.4 * largest) / (0.6 * largest);
        let [black, white] = [0.0, 1.0].map(|value| image(|_, _| [value; 3]));
        let found = of(&black, &white);
        assert!((found.mean() - expected).abs() < 1e-4, "{} {expected}", found.mean());
        assert!((found.max() - found.mean()).abs() < 1e-4);
    }

    /// CIELAB of an sRGB colour, with a* and b* adjusted for the Hunt effect (paper, sections 4.1.1 and 4.1.2); the
    /// white point is the sum of the primaries.
    fn hunt([r, g, b]: [u8; 3]) -> [f64; 3] {
        let linear = [r, g, b].map(|code| match f64::from(code) / 255.0 {
            c if c <= 0.04045 => c / 12.92,
            c => ((c + 0.055) / 1.055).powf(2.4),
        });
        let rows = [[0.412_4, 0.357_6, 0.180_5], [0.212_6, 0.715_2, 0.072_2], [0.019_3, 0.119_2, 0.950_5]];
        let [x, y, z] = rows.map(|row| {
            let part: f64 = (0..3).map(|i| row[i] * linear[i]).sum();
            match part / row.iter().sum::<f64>() {
                t if t > (6.0f64 / 29.0).powi(3) => t.cbrt(),
                t => t / (3.0 * (6.0f64 / 29.0).powi(2)) + 4.0 / 29.0,
            }
        });
        let lightness = 116.0 * y - 16.0;
        [lightness, 5.0 * lightness * (x - y), 2.0 * lightness * (y - z)]
    }

    /// FLIP of two constant pictures: filters do not change them, and they have no features. The HyAB distance to the
    /// power of 0.7; the first 0.4 of its maximum map to 0.95, the rest to the remaining 0.05 (section 4.1.3).
    fn even(a: [u8; 3], b: [u8; 3]) -> f64 {
        let distance = |a: [u8; 3], b: [u8; 3]| {
            let ([l, a, b], [m, c, d]) = (hunt(a), hunt(b));
            ((l - m).abs() + (a - c).hypot(b - d)).powf(0.7)
        };
        let (found, most) = (distance(a, b), distance([0, 255, 0], [0, 0, 255]));
        let knee = 0.4 * most;
        if found < knee { 0.95 * found / knee } else { 0.95 + 0.05 * (found - knee) / (most - knee) }
    }

    #[test]
    fn even_pictures_are_as_the_papers_formulas_have_it() {
        let pairs: [([u8; 3], [u8; 3]); 7] = [
            ([0; 3], [255; 3]),
            ([128; 3], [129; 3]),
            ([0; 3], [9; 3]),
            ([64, 128, 192], [70, 120, 190]),
            ([200, 30, 40], [30, 200, 40]),
            ([255, 0, 0], [0, 255, 255]),
            ([10, 20, 15], [240, 250, 230]),
        ];
        // Both sides of the knee.
        assert!(even(pairs[1].0, pairs[1].1) < 0.1 && even(pairs[5].0, pairs[5].1) > 0.95);
        for (a, b) in pairs {
            let [ours, truth] = [a, b].map(|codes| image(|_, _| codes.map(|code| f64::from(code) / 255.0)));
            let (found, expected) = (of(&ours, &truth), even(a, b));
            assert!((found.mean() - expected).abs() < 5e-4, "{a:?} {b:?}: {} {expected}", found.mean());
            assert!((found.max() - expected).abs() < 5e-4, "{a:?} {b:?}: {} {expected}", found.max());
        }
    }

    #[test]
    fn a_single_pixel_can_be_compared() {
        let map = flip(&[[1.0; 3]], &[[0.0; 3]], [1, 1], PIXELS_PER_DEGREE).unwrap();
        assert!((map.mean() - even([0; 3], [255; 3])).abs() < 5e-4, "{}", map.mean());
    }

    #[test]
    fn what_is_seen_from_afar_is_seen_less() {
        let dots = image(|x, y| if (x + y) % 2 == 0 { [1.0; 3] } else { [0.0; 3] });
        let grey = image(|_, _| [0.735_357; 3]);
        let [near, far] = [10.0, 200.0].map(|ppd| flip(&dots, &grey, SIZE, ppd).unwrap().mean());
        assert!(far < 0.5 * near, "{near} {far}");
        for ppd in [0.0, -67.0, f32::NAN, f32::INFINITY] {
            assert!(flip(&dots, &grey, SIZE, ppd).unwrap_err().to_string().contains("from 1 to 1000"));
        }
    }

    #[test]
    fn the_map_is_drawn_in_magma() {
        let map = Map { size: [2, 1], values: vec![0.0, 1.0] };
        // Published: #000004 and #fcfdbf.
        assert_eq!(map.coloured().unwrap().pixels(), [[0, 0, 4, 255], [252, 253, 191, 255]]);
    }
}
