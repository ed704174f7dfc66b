//! The weights of strata in the pixels about them. They are separable: a weight is a product of one along either axis.
//!
//! A stratum weighs what the filter weighs over all of it, wherever in it the ray goes: so the weights add up exactly, and a picture
//! without contrast is without error.

use super::options::Filter;

/// How many standard deviations of a Gaussian are kept at least.
const KEPT: f64 = 4.0;

/// A filter's weights, for 1, 2, 4 … strata along the side of a pixel.
#[derive(Clone, Debug)]
pub struct Kernel {
    /// How many pixels further than its own a ray counts, to either side.
    pub reach: usize,
    /// Stratum by stratum, the weights in the pixels from `reach` before its own to `reach` behind.
    levels: Vec<Vec<f64>>,
}

impl Kernel {
    /// For up to `most` strata along a side.
    pub fn new(filter: Filter, most: usize) -> Self {
        let (reach, below): (_, Box<dyn Fn(f64) -> f64>) = match filter {
            // Whole pixels about the centre's one, so that the cut is where pixels end: half a pixel further.
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

    /// How many pixels there are weights for, along an axis.
    pub fn width(&self) -> usize {
        2 * self.reach + 1
    }

    /// The weights along an axis of each of so many strata, a power of 2, in the pixels from `reach` before its own to `reach` behind.
    pub fn weights(&self, strata: usize) -> impl Iterator<Item = &[f64]> {
        self.levels[strata.ilog2() as usize].chunks(self.width())
    }

    /// Variance of a filtered value, where every pixel's own mean has variance 1.
    pub fn gain(&self) -> f64 {
        let squares: f64 = self.levels[0].iter().map(|weight| weight * weight).sum();
        squares * squares
    }
}
