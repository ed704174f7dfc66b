//! Bounds of filtered pixels: those of their neighbours, convolved with the filter.

use super::Value;
use super::filter::convolved;
use crate::settings::{Alpha, Settings};

/// Range of a pixel's values before the filter, and the tolerance of its colour.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelRange {
    /// Least premultiplied colour and α.
    low: [f64; 4],
    /// Greatest.
    high: [f64; 4],
    /// See [`super::Tolerance::colour`].
    limit: f64,
}

/// Ranges of the pixels of a filtered picture.
pub(super) struct FilteredBounds {
    /// `low`, `high`, `limit`.
    ranges: Vec<[f64; 9]>,
    alpha: Alpha,
    background: Option<[f64; 3]>,
}

impl PixelRange {
    /// The range of no value, with this tolerance.
    pub fn new(limit: f64) -> Self {
        Self { low: [f64::INFINITY; 4], high: [f64::NEG_INFINITY; 4], limit }
    }

    /// The range of pixels whose value is unknown: any colour is admissible.
    pub fn unknown() -> Self {
        Self { low: [f64::NEG_INFINITY; 4], high: [f64::INFINITY; 4], limit: f64::INFINITY }
    }

    /// The range with another admissible value, of this tolerance.
    pub fn with(mut self, value: &Value, limit: f64) -> Self {
        let [r, g, b, a] = value.colour;
        for (k, channel) in [a * r, a * g, a * b, a].into_iter().enumerate() {
            self.low[k] = self.low[k].min(channel);
            self.high[k] = self.high[k].max(channel);
        }
        self.limit = self.limit.max(limit);
        self
    }

    fn to_array(self) -> [f64; 9] {
        let PixelRange { low: [a, b, c, d], high: [e, f, g, h], limit } = self;
        [a, b, c, d, e, f, g, h, limit]
    }
}

impl FilteredBounds {
    /// Convolves the ranges of a picture of `size` px.
    pub fn new(settings: &Settings, pixels: Vec<PixelRange>, size: [u32; 2]) -> Self {
        let ranges: Vec<_> = pixels.into_iter().map(PixelRange::to_array).collect();
        Self {
            ranges: convolved(settings, &ranges, size),
            alpha: settings.drawn_alpha(),
            background: settings.background.map(|colour| colour.map(f64::from)),
        }
    }

    /// Distance of a pixel's colour from its range, and the largest that passes.
    pub fn distance(&self, index: usize, Value { covered, colour, .. }: &Value) -> (f64, f64) {
        let [r0, g0, b0, a0, r1, g1, b1, a1, limit] = self.ranges[index];
        let ([mut low, mut high], mut limit) = ([[r0, g0, b0], [r1, g1, b1]], limit);
        let [r, g, b, a] = *colour;
        let mut seen = [r, g, b];
        let mut alpha = None;
        match (self.alpha, self.background) {
            (Alpha::Coverage, None) => {
                seen = seen.map(|channel| a * channel);
                alpha = Some((a, [a0, a1]));
            }
            (Alpha::Coverage, Some(behind)) => {
                for k in 0..3 {
                    low[k] += (1.0 - a1) * behind[k].max(0.0) + (1.0 - a0) * behind[k].min(0.0);
                    high[k] += (1.0 - a0) * behind[k].max(0.0) + (1.0 - a1) * behind[k].min(0.0);
                }
            }
            (Alpha::Mask, background) if !covered => [low, high] = [background.unwrap_or_default(); 2],
            // The colour of a mask is the mean over the pixels with a surface.
            (Alpha::Mask, _) => {
                low = low.map(|channel| channel / a1);
                high = high.map(|channel| channel / a0);
                limit /= a0;
            }
        }
        let outside = |value: f64, [low, high]: [f64; 2]| (low - value).max(value - high).max(0.0);
        let colours = (0..3).map(|k| outside(seen[k], [low[k], high[k]]));
        let all = colours.chain(alpha.map(|(alpha, range)| outside(alpha, range)));
        let worst = all.fold(0.0, |most: f64, one| if one.is_nan() || one > most { one } else { most });
        (worst, limit)
    }
}
