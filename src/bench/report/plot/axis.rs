//! Axes of plots: scales, ranges and ticks.

use crate::bench::format::{scientific, significant};
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// An axis whose range contains all values, with a margin.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    scale: Scale,
    /// The ends, after [`Scale::forth`].
    ends: [f64; 2],
    ticks: Vec<(f64, String)>,
    minor: Vec<f64>,
}

/// Scale of an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps are equal differences.
    Linear,
    /// Equal steps are equal factors. Values that are not above 0 lie on the lower edge, which has a label of its own.
    Log,
}

/// Least number of labelled ticks, if the values allow.
const LEAST: usize = 3;
/// Greatest number of labelled ticks.
const MOST: usize = 7;
/// Margin at either end, as a share of the range of the values.
const MARGIN: f64 = 0.06;

impl Scale {
    fn forth(self, value: f64) -> f64 {
        match self {
            // The difference of larger numbers would be infinite.
            Self::Linear => value.clamp(-1e300, 1e300),
            Self::Log => value.log10(),
        }
    }

    fn back(self, length: f64) -> f64 {
        match self {
            Self::Linear => length,
            Self::Log => 10f64.powf(length),
        }
    }

    /// Whether the scale can show the value.
    fn holds(self, value: f64) -> bool {
        value.is_finite() && (self == Self::Linear || value > 0.0)
    }
}

impl Axis {
    /// An axis over values of any kind: NaN is ignored, and values that the scale cannot show lie on an edge.
    pub fn over(label: impl Into<String>, scale: Scale, values: impl IntoIterator<Item = f64>) -> Self {
        Self::above(label, scale, f64::NEG_INFINITY, values)
    }

    /// The same, with values below `floor` on the lower edge.
    pub fn above(
        label: impl Into<String>,
        scale: Scale,
        floor: f64,
        values: impl IntoIterator<Item = f64>,
    ) -> Self {
        let values: Vec<f64> = values.into_iter().filter(|value| !value.is_nan()).collect();
        let shown = |value: &f64| scale.holds(*value) && *value >= floor;
        let lengths = values.iter().filter(|value| shown(value)).map(|value| scale.forth(*value));
        let [low, high] = lengths.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], length| {
            [low.min(length), high.max(length)]
        });
        let [low, high] = if low <= high { [low, high] } else { [0.0, 1.0] };
        let below = values.iter().find(|value| !shown(value) && **value < f64::INFINITY);
        let above = values.contains(&f64::INFINITY);
        let span = span(scale, low, high);
        let middle = 0.5 * (low + high);
        let half = 0.5 * span + MARGIN * span;
        // Values off the scale get a share of the axis to themselves.
        let edge = |off: bool| if off { 0.15 * span } else { 0.0 };
        let ends = [middle - half - edge(below.is_some()), middle + half + edge(above)];
        let mut axis = Self { label: label.into(), scale, ends, ticks: Vec::new(), minor: Vec::new() };
        axis.mark();
        let least = if values.iter().any(|value| !shown(value) && *value > 0.0 && value.is_finite()) {
            "less"
        } else {
            "0"
        };
        axis.mark_edges(below.map(|_| least), above.then_some("∞"));
        axis
    }

    /// The scale.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Position of a value: 0 at the lower end, 1 at the upper one; clamped.
    pub fn share(&self, value: f64) -> f64 {
        let [low, high] = self.ends;
        if self.scale.holds(value) {
            ((self.scale.forth(value) - low) / (high - low)).clamp(0.0, 1.0)
        } else if value > 0.0 {
            1.0
        } else {
            0.0
        }
    }

    /// Chooses the coarsest sufficient ticks, or the finest.
    fn mark(&mut self) {
        let [low, high] = self.ends;
        let inside = |values: Vec<f64>| {
            let within = |value: &f64| (low..=high).contains(&self.scale.forth(*value));
            values.into_iter().filter(within).collect::<Vec<_>>()
        };
        let sets = sets(self.scale, low, high).into_iter().map(|set| set.map(inside));
        let enough = |set: &[Vec<f64>; 2]| set[0].len() >= LEAST;
        let best = sets.reduce(|best, set| if enough(&best) { best } else { set });
        let [ticks, minor] = best.unwrap_or_default();
        let labels = labels(&ticks, self.scale);
        self.ticks = ticks.into_iter().zip(labels).collect();
        self.minor = minor;
    }

    /// Labels the edges that hold values off the scale, in place of ticks that are too near.
    fn mark_edges(&mut self, below: Option<&str>, above: Option<&str>) {
        let [low, high] = self.ends;
        let near = 0.08;
        for (label, end, share) in [(below, low, 0.0), (above, high, 1.0)] {
            if let Some(label) = label {
                let ticks = std::mem::take(&mut self.ticks);
                self.ticks = ticks
                    .into_iter()
                    .filter(|(value, _)| (self.share(*value) - share).abs() > near)
                    .collect();
                self.ticks.push((self.scale.back(end), label.to_owned()));
            }
        }
    }
}

/// Length of the axis without margins; above 0 even if all values are equal.
fn span(scale: Scale, low: f64, high: f64) -> f64 {
    let least = match scale {
        Scale::Linear => (0.02 * low.abs().max(high.abs())).max(f64::MIN_POSITIVE),
        Scale::Log => 0.1,
    };
    let least = if low == high && scale == Scale::Log { 0.6 } else { least };
    let least = if low == high && low == 0.0 && scale == Scale::Linear { 1.0 } else { least };
    (high - low).max(least)
}

/// Round values for ticks, and those for the grid between them; each set is finer than the one before.
fn sets(scale: Scale, low: f64, high: f64) -> Vec<[Vec<f64>; 2]> {
    let [least, greatest] = [scale.back(low), scale.back(high)];
    let steps = |count: f64| linear(least, greatest, (greatest - least) / count);
    if scale == Scale::Linear {
        return vec![[steps(MOST as f64 - 1.0), steps(25.0)]];
    }
    let powers = low.floor() as i32..=high.ceil() as i32;
    let decades = (high.floor() - low.ceil() + 1.0).max(0.0) as usize;
    let every = decades.div_ceil(MOST).max(1) as i32;
    let coarse = powers.clone().filter(|power| power.rem_euclid(every) == 0).map(|power| decimal(1, power));
    let times = |factors: &[i32]| {
        let all = powers.clone().flat_map(|power| factors.iter().map(move |factor| decimal(*factor, power)));
        all.collect::<Vec<_>>()
    };
    // With many decades, a finer grid would be a grey area.
    let fine = times(if decades < 8 { &[1, 2, 3, 4, 5, 6, 7, 8, 9] } else { &[1] });
    vec![
        [coarse.collect(), fine.clone()],
        [times(&[1, 2, 5]), fine.clone()],
        [times(&[1, 2, 3, 4, 6, 8]), fine],
        [steps(5.0), steps(20.0)],
    ]
}

/// Multiples of a round step.
fn linear(least: f64, greatest: f64, step: f64) -> Vec<f64> {
    if !(step.is_finite() && step > 0.0) {
        return Vec::new();
    }
    let power = step.log10().floor() as i32;
    let round = [decimal(1, power), decimal(2, power), decimal(5, power), decimal(1, power + 1)];
    let Some(step) = round.into_iter().find(|round| *round >= step * (1.0 - 1e-9)) else { return Vec::new() };
    let (first, last) = ((least / step).ceil(), (greatest / step).floor());
    // A range below rounding has no steps.
    if !(last - first).is_finite() || last - first > 1e3 {
        return Vec::new();
    }
    // Parsed from text, so that the third tenth is 0.3.
    let tidy = |value: f64| format!("{value:.12e}").parse().unwrap_or(value);
    (0..=(last - first) as u32).map(|i| tidy((first + f64::from(i)) * step)).collect()
}

/// The number nearest to `factor · 10^power`.
fn decimal(factor: i32, power: i32) -> f64 {
    format!("{factor}e{power}").parse().unwrap_or(f64::NAN)
}

/// Plain if all are short, else as powers of ten.
fn labels(values: &[f64], scale: Scale) -> Vec<String> {
    let short = |value: &f64| *value == 0.0 || (9e-5..2e4).contains(&value.abs());
    let plain = values.iter().all(short) || (scale == Scale::Linear && values.iter().all(|v| v.abs() < 1e6));
    let label =
        |value: &f64| if plain || *value == 0.0 { significant(*value, 8) } else { scientific(*value) };
    values.iter().map(label).collect()
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        limit.0 + (f64::from(limit.1 - limit.0) * self.share(*value)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() {
            self.minor.clone()
        } else {
            self.ticks.iter().map(|(value, _)| *value).collect()
        }
    }

    fn range(&self) -> Range<f64> {
        let [low, high] = self.ends.map(|end| self.scale.back(end));
        low..high
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        let tick = self.ticks.iter().find(|(tick, _)| tick == value);
        tick.map(|(_, label)| label.clone()).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(scale: Scale, values: &[f64]) -> Vec<String> {
        let axis = Axis::over("", scale, values.iter().copied());
        axis.ticks.into_iter().map(|(_, label)| label).collect()
    }

    #[test]
    fn ticks_are_round_and_enough() {
        assert_eq!(ticks(Scale::Log, &[1e4, 1e6]), ["10⁴", "10⁵", "10⁶"]);
        assert_eq!(ticks(Scale::Log, &[12.0, 900.0]), ["10", "100", "1000"]);
        assert_eq!(ticks(Scale::Log, &[13.0, 600.0]), ["20", "50", "100", "200", "500"]);
        assert_eq!(ticks(Scale::Log, &[0.02, 0.09]), ["0.02", "0.03", "0.04", "0.06", "0.08"]);
        assert_eq!(ticks(Scale::Log, &[1e-9, 1e-3]).len(), 7);
        assert_eq!(ticks(Scale::Linear, &[0.0, 1.0]), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert!(ticks(Scale::Log, &[281.0, 307.0]).len() >= LEAST);
    }

    #[test]
    fn every_value_has_a_place() {
        let hard = [0.0, -1.0, 5.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 1e300, 1e-300, f64::MAX];
        for scale in [Scale::Log, Scale::Linear] {
            for values in [&hard[..], &hard[..1], &hard[2..3], &hard[3..4], &hard[5..6], &hard[8..], &[]] {
                let axis = Axis::over("", scale, values.iter().copied());
                for value in hard {
                    let place = axis.map(&value, (10, 90));
                    assert!((10..=90).contains(&place), "{value} in {values:?}: {place}");
                }
            }
        }
    }

    #[test]
    fn what_is_off_the_scale_is_labelled() {
        assert_eq!(ticks(Scale::Log, &[0.0, 1e-6, 1e-4]).last().map(String::as_str), Some("0"));
        assert!(ticks(Scale::Log, &[1.0, 10.0, f64::INFINITY]).contains(&"∞".to_owned()));
    }
}
