//! What an exact image is asked to be.

use crate::error::{Error, Result};

/// How the rays about a pixel become its value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Filter {
    /// The low-pass of EWA splatting, of this variance in px²; cut off where it has fallen below e⁻⁸ along both axes.
    Gaussian {
        /// Variance, px².
        variance: f64,
    },
    /// The mean over the pixel's square.
    Box,
    /// No filter: the one ray through the pixel's centre.
    Point,
}

/// How an exact image is made.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// The filter of the pixels.
    pub filter: Filter,
    /// Standard error that no pixel should exceed; see [`Achieved`](super::Achieved) for what it is of.
    pub error: f64,
    /// Rays after which a pixel is left as it is, rounded down to a power of 4.
    pub most_samples: u32,
}

impl Default for Options {
    fn default() -> Self {
        Self { filter: Filter::Gaussian { variance: 1.0 }, error: 1.0 / 1024.0, most_samples: 1024 }
    }
}

/// Greatest variance of a Gaussian, px²: its weights reach 40 px.
pub const MOST_VARIANCE: f64 = 100.0;

/// Most rays a pixel.
pub const MOST_SAMPLES: u32 = 1 << 16;

/// Fewest strata along the side of a pixel.
pub(super) const FEWEST_STRATA: u32 = 4;

impl Options {
    /// Refuses what no image can be made of.
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

    /// Most strata along the side of a pixel.
    pub(super) fn most_strata(&self) -> u32 {
        1 << (self.most_samples.ilog2() / 2)
    }
}
