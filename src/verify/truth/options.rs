//! Options of exact images.

use crate::error::{Error, Result};

/// Pixel filter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// The low-pass filter of EWA splatting, with this variance in px²; cut off where it is below e⁻⁸ along both axes.
    Gaussian {
        /// Variance, px².
        variance: f64,
    },
    /// The mean over the pixel's square.
    Box,
    /// No filter: one ray through the pixel's centre.
    Point,
}

impl Filter {
    /// A Gaussian with a variance of 1 px².
    pub const DEFAULT: Self = Self::Gaussian { variance: 1.0 };
}

/// Options of an exact image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Pixel filter.
    pub filter: Filter,
    /// Standard error that no pixel should exceed; see [`StandardError`](super::StandardError).
    pub error: f64,
    /// Greatest number of rays per pixel, rounded down to a power of 4.
    pub most_samples: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self { filter: Filter::DEFAULT, error: 1.0 / 1024.0, most_samples: 1024 }
    }
}

/// Greatest variance of a Gaussian, px²: its weights reach 40 px.
pub const MOST_VARIANCE: f64 = 100.0;

/// Most rays per pixel.
pub const MOST_SAMPLES: u32 = 1 << 16;

/// Least number of strata along the side of a pixel.
pub(super) const FEWEST_STRATA: u32 = 4;

impl Options {
    /// Validates the options.
    ///
    /// # Errors
    /// [`Error::Usage`].
    pub fn check(&self) -> Result<()> {
        let refuse = |text: String| Err(Error::Usage(text));
        match self.filter {
            Filter::Gaussian { variance } if !(variance > 0.0 && variance <= MOST_VARIANCE) => {
                return refuse(format!(
                    "the filter's variance is {variance} px²: give a number above 0 and at most {MOST_VARIANCE}"
                ));
            }
            _ => {}
        }
        if !(self.error.is_finite() && self.error > 0.0) {
            return refuse(format!("the error is {}: give a finite number above 0", self.error));
        }
        let fewest = FEWEST_STRATA * FEWEST_STRATA;
        if !(fewest..=MOST_SAMPLES).contains(&self.most_samples) {
            return refuse(format!(
                "{} rays a pixel at most: give {fewest} to {MOST_SAMPLES}",
                self.most_samples
            ));
        }
        Ok(())
    }

    /// Greatest number of strata along the side of a pixel.
    pub(super) fn most_strata(&self) -> u32 {
        1 << (self.most_samples.ilog2() / 2)
    }
}
