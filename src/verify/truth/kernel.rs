//! Filter weights of strata in the surrounding pixels. They are separable: products of one weight per axis.
//!
//! A stratum's weight is the filter's integral over it, wherever in it the ray lies. The weights therefore add up to 1
//! exactly, and a picture without contrast has no error.

use super::options::Filter;

/// Standard deviations of a Gaussian that are kept, at least.
const KEPT: f64 = 4.0;

/// A filter's weights for 1, 2, 4 … strata along the side of a pixel.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// Reach of a ray beyond its own pixel, in pixels on either side.
    pub reach: usize,
    /// Per stratum: weights in the pixels from `reach` before its own to `reach` after it.
    levels: Vec<Vec<f64>>,
}

impl Kernel {
    /// Weights for up to `most` strata along a side.
    pub fn new(filter: Filter, most: usize) -> Self {
        let (reach, below): (_, Box<dyn Fn(f64) -> f64>) = match filter {
            // Whole pixels around the centre, so that the cut is at a pixel border: half a pixel further.
            Filter::Gaussian { variance } => {
                let reach = (KEPT * variance.sqrt()).ceil() as usize;
                let below = move |x: f64| 0.5 * libm::erfc(-x / (2.0 * variance).sqrt());
                let end = reach as f64 + 0.5;
                let whole = below(end) - below(-end);
                (reach, Box::new(move |x| below(x) / whole))
            }
            Filter::Box | Filter::Point => (0, Box::new(|x| x)),
        };
        let level = |strata: usize| {
            let edge = |index: usize| index as f64 / strata as f64 - 0.5;
            let weights = |stratum: usize| {
                let below = &below;
                (0..2 * reach + 1).map(move |pixel| {
                    let shift = reach as f64 - pixel as f64;
                    below(edge(stratum + 1) + shift) - below(edge(stratum) + shift)
                })
            };
            (0..strata).flat_map(weights).collect()
        };
        Self { reach, levels: (0..=most.ilog2()).map(|log| level(1 << log)).collect() }
    }

    /// Number of pixels with weights along an axis.
    pub fn width(&self) -> usize {
        2 * self.reach + 1
    }

    /// Weights along an axis of each of `strata` strata, a power of 2, in the pixels from `reach` before its own to
    /// `reach` after it.
    pub fn weights(&self, strata: usize) -> impl Iterator<Item = &[f64]> {
        self.levels[strata.ilog2() as usize].chunks(self.width())
    }

    /// Variance of a filtered value if every pixel's mean has variance 1.
    pub fn gain(&self) -> f64 {
        let squares: f64 = self.levels[0].iter().map(|weight| weight * weight).sum();
        squares * squares
    }
}
