//! Colour maps for scalars.

use super::Colours;
use rayon::prelude::*;

/// A colour map over the range from 0 to 1. All maps but `Turbo` are perceptually uniform, with increasing lightness.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    strum::EnumMessage,
    strum::EnumString,
    strum::IntoStaticStr,
    strum::VariantArray,
)]
#[strum(serialize_all = "kebab-case")]
pub enum ColourMap {
    /// Purple, green, yellow.
    #[default]
    Viridis,
    /// Blue, grey, yellow: the same for colour-blind viewers.
    Cividis,
    /// Black, red, pale yellow.
    Magma,
    /// Black, orange, yellow.
    Inferno,
    /// Blue, pink, yellow.
    Plasma,
    /// A rainbow: most distinct colours; lightness rises and falls.
    Turbo,
    /// Dark grey to white.
    Grey,
}

/// Code of the first colour of `Grey`: black would not be seen on black.
const DARK: f64 = 48.0;

/// Colour of NaN and infinity.
const NONE: [u8; 3] = [128; 3];

/// Percentiles of the default range, so that a few outliers do not compress all other values.
const PERCENTILES: [f64; 2] = [0.01, 0.99];

/// Range of a colour map.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// Value of the first colour; lesser values have the same colour.
    pub min: f64,
    /// Value of the last colour; greater values have the same colour.
    pub max: f64,
}

/// A colour map with its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ColourScale {
    /// The colours.
    pub map: ColourMap,
    /// Values of the ends.
    pub range: ValueRange,
}

impl ColourMap {
    /// The sRGB-encoded colour at `share` from 0 to 1; values beyond have the colour of the nearer end.
    pub fn at(self, share: f64) -> [u8; 3] {
        let gradient = match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Cividis => colorous::CIVIDIS,
            Self::Magma => colorous::MAGMA,
            Self::Inferno => colorous::INFERNO,
            Self::Plasma => colorous::PLASMA,
            Self::Turbo => colorous::TURBO,
            Self::Grey => return [(DARK + (255.0 - DARK) * share.clamp(0.0, 1.0)).round() as u8; 3],
        };
        gradient.eval_continuous(share.clamp(0.0, 1.0)).as_array()
    }
}

impl ValueRange {
    /// From the 1st to the 99th percentile of the finite `values`, and the number of these; `None` if there are none.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<(Self, u64)> {
        let mut finite: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        let last = finite.len().checked_sub(1)?;
        let [min, max] = PERCENTILES.map(|percentile| {
            let rank = (percentile * last as f64).round() as usize;
            *finite.select_nth_unstable_by(rank, f64::total_cmp).1
        });
        Some((Self { min, max }, finite.len() as u64))
    }

    /// Position of `value` in the range: 0 at `min`, 1 at `max`; ½ everywhere if they are equal.
    pub fn share(&self, value: f64) -> f64 {
        // Halved first: the difference of two finite numbers may be infinite.
        let half = 0.5 * self.max - 0.5 * self.min;
        if half > 0.0 { (0.5 * value - 0.5 * self.min) / half } else { 0.5 }
    }
}

impl ColourScale {
    /// The colour of `value`, sRGB-encoded; grey if it is not finite.
    pub fn at(&self, value: f64) -> [u8; 3] {
        if value.is_finite() { self.map.at(self.range.share(value)) } else { NONE }
    }

    /// The colours of `values`.
    pub fn colours(&self, values: impl IndexedParallelIterator<Item = f64>) -> Colours {
        let code = |value| {
            let [r, g, b] = self.at(value);
            [r, g, b, 0]
        };
        Colours::Srgb8(values.map(code).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCALE: ColourScale =
        ColourScale { map: ColourMap::Viridis, range: ValueRange { min: 10.0, max: 20.0 } };

    #[test]
    fn ends_and_what_lies_beyond_have_the_end_colours() {
        // Published: #440154 and #fde725.
        let (first, last) = ([68, 1, 84], [253, 231, 37]);
        assert_eq!([9.0, 10.0, -f64::MAX].map(|value| SCALE.at(value)), [first; 3]);
        assert_eq!([20.0, 21.0, f64::MAX].map(|value| SCALE.at(value)), [last; 3]);
        assert_ne!(SCALE.at(15.0), SCALE.at(16.0));
        for map in
            [ColourMap::Cividis, ColourMap::Magma, ColourMap::Inferno, ColourMap::Plasma, ColourMap::Grey]
        {
            let light = |share| map.at(share).iter().map(|&code| u32::from(code)).sum::<u32>();
            assert!(light(0.0) < light(0.5) && light(0.5) < light(1.0), "{map:?}");
        }
    }

    #[test]
    fn what_is_no_number_is_grey() {
        assert_eq!([f64::NAN, f64::INFINITY].map(|value| SCALE.at(value)), [NONE; 2]);
    }

    #[test]
    fn a_range_leaves_out_stray_values() {
        let values = (0..1001).rev().map(f64::from).chain([f64::NAN, f64::INFINITY]);
        assert_eq!(ValueRange::of(values), Some((ValueRange { min: 10.0, max: 990.0 }, 1001)));
        assert_eq!(ValueRange::of([f64::NAN]), None);
        assert_eq!(ValueRange::of([]), None);
    }

    #[test]
    fn constant_and_extreme_values_have_a_place() {
        let (constant, count) = ValueRange::of([3.0; 5]).unwrap();
        assert_eq!((constant.share(3.0), count), (0.5, 5));
        let all = ValueRange { min: -f64::MAX, max: f64::MAX };
        assert_eq!([-f64::MAX, 0.0, f64::MAX].map(|value| all.share(value)), [0.0, 0.5, 1.0]);
    }
}
