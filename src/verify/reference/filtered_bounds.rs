//! Bounds of pixels after passes that read neighbours, eye-dome lighting and the filter, from bounds of the pixels before them.

use super::filter::convolved;
use super::{Projector, Value, edl};
use crate::settings::{Alpha, Shading};

/// Range of a pixel's values before the filter, and the tolerance of its colour.
#[derive(Clone, Copy, Debug)]
pub(super) struct PixelRange {
    /// Least premultiplied colour and α.
    low: [f64; 4],
    /// Greatest.
    high: [f64; 4],
    /// Distances of the nearest and the farthest surface that it may show; infinite and 0 if there is none.
    near: f64,
    far: f64,
    /// Whether it may show no surface.
    may_be_empty: bool,
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
        let [low, high] = [f64::INFINITY, f64::NEG_INFINITY].map(|end| [end; 4]);
        Self { low, high, near: f64::INFINITY, far: 0.0, may_be_empty: false, limit }
    }

    /// The range of pixels whose value is unknown: any colour is admissible.
    pub fn unknown() -> Self {
        let [low, high] = [f64::NEG_INFINITY, f64::INFINITY].map(|end| [end; 4]);
        let [near, far] = [f64::MIN_POSITIVE, f64::INFINITY];
        Self { low, high, near, far, may_be_empty: true, limit: f64::INFINITY }
    }

    /// The range with another admissible value, of this tolerance and of this relative error of the distance.
    pub fn with(mut self, value: &Value, limit: f64, depth_error: f64) -> Self {
        if value.covered {
            self.near = self.near.min(value.depth * (1.0 - depth_error));
            self.far = self.far.max(value.depth * (1.0 + depth_error));
        } else {
            self.may_be_empty = true;
        }
        let [r, g, b, a] = value.colour;
        for (k, channel) in [a * r, a * g, a * b, a].into_iter().enumerate() {
            self.low[k] = self.low[k].min(channel);
            self.high[k] = self.high[k].max(channel);
        }
        self.limit = self.limit.max(limit);
        self
    }

    /// Multiplies the colour by any number from `least` to `most`, at least 0.
    fn times(&mut self, [least, most]: [f64; 2]) {
        for k in 0..3 {
            self.low[k] *= if self.low[k] < 0.0 { most } else { least };
            self.high[k] *= if self.high[k] < 0.0 { least } else { most };
        }
    }

    fn to_array(self) -> [f64; 9] {
        let PixelRange { low: [a, b, c, d], high: [e, f, g, h], limit, .. } = self;
        [a, b, c, d, e, f, g, h, limit]
    }
}

/// The ranges under eye-dome lighting.
fn darken(projector: &Projector, pixels: &mut [PixelRange], size: [u32; 2]) {
    let [nears, fars] =
        [|p: &PixelRange| p.near, |p: &PixelRange| p.far].map(|of| pixels.iter().map(of).collect::<Vec<_>>());
    let emptied: Vec<f64> = pixels.iter().map(|p| if p.may_be_empty { 0.0 } else { p.far }).collect();
    let least = edl::factors(projector, size, &fars, &nears);
    let most = edl::factors(projector, size, &nears, &emptied);
    for (pixel, factors) in pixels.iter_mut().zip(least.into_iter().zip(most)) {
        pixel.times(factors.into());
    }
}

impl FilteredBounds {
    /// The ranges of a picture of `size` px after the passes.
    pub fn new(projector: &Projector, mut pixels: Vec<PixelRange>, size: [u32; 2]) -> Self {
        let settings = &projector.settings;
        if settings.shading == Shading::Edl {
            darken(projector, &mut pixels, size);
        }
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
