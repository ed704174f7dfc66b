//! The weights of a ray in the pixels about it. They are separable: a weight is a product of one along either axis.

use super::options::Filter;

/// How many standard deviations of a Gaussian are kept at least.
const KEPT: f64 = 4.0;

/// A filter's weights along one axis.
#[derive(Clone, Copy, Debug)]
pub struct Kernel {
    /// How many pixels further than its own a ray counts, to either side.
    pub reach: usize,
    /// −1 / (2 variance); 0 for one pixel's box.
    factor: f64,
}

impl Kernel {
    pub fn new(filter: Filter) -> Self {
        match filter {
            // Whole pixels about the centre's one, so that the cut is where the pixels end: half a pixel further.
            Filter::Gaussian { variance } => {
                Self { reach: (KEPT * variance.sqrt()).ceil() as usize, factor: -0.5 / variance }
            }
            Filter::Box | Filter::Point => Self { reach: 0, factor: 0.0 },
        }
    }

    /// How many pixels there are weights for.
    pub fn width(&self) -> usize {
        2 * self.reach + 1
    }

    /// The weights in the pixels from `reach` before its own to `reach` behind; `offset` is the ray's, from 0 to 1 in its own pixel.
    pub fn weigh(&self, offset: f64, weights: &mut [f64]) {
        for (index, weight) in weights.iter_mut().enumerate() {
            let distance = offset - 0.5 + self.reach as f64 - index as f64;
            *weight = (self.factor * distance * distance).exp();
        }
    }

    /// Variance of a filtered value, where every pixel's own mean has variance 1: `Σ W²`, with `Σ W = 1` over the pixels.
    pub fn gain(&self) -> f64 {
        let mut weights = vec![0.0; self.width()];
        self.weigh(0.5, &mut weights);
        let sum: f64 = weights.iter().sum();
        let squares: f64 = weights.iter().map(|weight| weight * weight).sum();
        (squares / (sum * sum)).powi(2)
    }
}
