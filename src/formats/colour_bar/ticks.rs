//! Ticks of a scale and their labels.

use super::BarValues;
use crate::formats::class_name;
use crate::geometry::ValueRange;

/// A tick of a scale.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Position: 0 at the minimum, 1 at the maximum.
    pub share: f64,
    /// Label of the value.
    pub label: String,
}

/// Approximate number of round values between the ends.
const STEPS: f64 = 5.0;
/// Longest plain number; longer ones get an exponent.
const LONGEST: usize = 10;

/// Both ends, and round values between them that are at least `apart` from an end (1 is the whole scale). One tick if the ends are equal.
pub(super) fn ticks(range: &ValueRange, apart: f64, values: BarValues) -> Vec<Tick> {
    let mut ticks = ticks_of_numbers(range, apart, if values == BarValues::Numbers { 0.0 } else { 1.0 });
    if values == BarValues::Classes {
        let name = |label: &str| label.parse().ok().and_then(class_name);
        ticks.iter_mut().for_each(|tick| tick.label.extend(name(&tick.label).map(|name| format!(" {name}"))));
    }
    ticks
}

/// The same, of numbers that differ by at least `least`.
fn ticks_of_numbers(range: &ValueRange, apart: f64, least: f64) -> Vec<Tick> {
    let ValueRange { min, max } = *range;
    let span = max - min;
    // A range of width 0, or of infinite width, has only its ends.
    let step = if span > 0.0 && span.is_finite() { round_step(span / STEPS).max(least) } else { 0.0 };
    if step == 0.0 || min + step == min {
        let ends = if min == max { vec![min] } else { vec![min, max] };
        return ends
            .into_iter()
            .map(|v| Tick { share: range.share(v), label: number(v, v.abs() * 1e-3) })
            .collect();
    }
    let end = |value| Tick { share: range.share(value), label: number(value, 0.01 * step) };
    let first = (min / step).ceil();
    let round = (0..=STEPS as u32 * 2).map(|i| (first + f64::from(i)) * step);
    let between = round
        .map(|value| Tick { share: range.share(value), label: number(value, step) })
        .filter(|tick| tick.share >= apart && tick.share <= 1.0 - apart);
    std::iter::once(end(min)).chain(between).chain([end(max)]).collect()
}

/// The least of 1, 2 and 5 times a power of ten that is at least `least`.
fn round_step(least: f64) -> f64 {
    let power = 10f64.powf(least.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= least * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

/// `value` with enough digits to differ from a number `spacing` away.
fn number(value: f64, spacing: f64) -> String {
    let exponent = |v: f64| if v == 0.0 { 0.0 } else { v.abs().log10().floor() };
    let decimals = (-exponent(spacing)).max(0.0);
    let plain = format!("{value:.*}", decimals.min(20.0) as usize);
    // No sign on a rounded 0.
    let plain = if plain.parse() == Ok(0.0) { "0".to_owned() } else { shorten(plain) };
    if plain.len() <= LONGEST && (plain != "0" || value == 0.0 || value.abs() < spacing) {
        return plain;
    }
    let digits = (exponent(value) - exponent(spacing)).clamp(0.0, 12.0);
    let text = format!("{value:.*e}", digits as usize);
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    format!("{}e{exponent}", shorten(mantissa.to_owned()))
}

/// Removes trailing zeros.
fn shorten(number: String) -> String {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.').to_owned() } else { number }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(min: f64, max: f64) -> Vec<String> {
        labels_of(min, max, BarValues::Numbers)
    }

    fn labels_of(min: f64, max: f64, values: BarValues) -> Vec<String> {
        ticks(&ValueRange { min, max }, 0.05, values).into_iter().map(|tick| tick.label).collect()
    }

    #[test]
    fn whole_numbers_have_none_between_them_and_classes_have_names() {
        assert_eq!(labels_of(1.0, 3.0, BarValues::Integers), ["1", "2", "3"]);
        assert_eq!(labels_of(1.0, 2.0, BarValues::Integers), ["1", "2"]);
        assert_eq!(labels_of(7.0, 7.0, BarValues::Integers), ["7"]);
        assert_eq!(labels_of(0.0, 40.0, BarValues::Integers), ["0", "10", "20", "30", "40"]);
        assert_eq!(labels_of(1.0, 2.0, BarValues::Classes), ["1 unclassified", "2 ground"]);
        assert_eq!(labels_of(200.0, 201.0, BarValues::Classes), ["200", "201"]);
    }

    #[test]
    fn ticks_are_round_and_the_ends_are_labelled() {
        assert_eq!(labels(0.0, 255.0), ["0", "100", "200", "255"]);
        assert_eq!(labels(0.0, 1.0), ["0", "0.2", "0.4", "0.6", "0.8", "1"]);
        assert_eq!(labels(-0.033, 0.187), ["-0.033", "0", "0.05", "0.1", "0.15", "0.187"]);
        // 4 600 001 is too near to the end.
        assert_eq!(labels(4600000.98, 4600003.5), ["4600000.98", "4600002", "4600003", "4600003.5"]);
        assert_eq!(labels(2e-12, 8e-12)[0], "2e-12");
        assert_eq!(labels(0.0, 3e20).last().unwrap(), "3e20");
    }

    #[test]
    fn marks_lie_where_their_values_are() {
        for tick in ticks(&ValueRange { min: -3.0, max: 17.0 }, 0.0, BarValues::Numbers) {
            let value: f64 = tick.label.parse().unwrap();
            assert!((tick.share - (value + 3.0) / 20.0).abs() < 1e-12, "{tick:?}");
        }
    }

    #[test]
    fn a_range_without_room_has_its_ends_alone() {
        assert_eq!(labels(7.0, 7.0), ["7"]);
        assert_eq!(labels(0.0, 0.0), ["0"]);
        assert_eq!(labels(-f64::MAX, f64::MAX).len(), 2);
        let close = f64::from_bits(1e7f64.to_bits() + 1);
        assert!(labels(1e7, close).len() <= 2);
        assert!(labels(0.0, f64::MIN_POSITIVE).len() >= 2);
    }
}
