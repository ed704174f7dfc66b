//! Distribution of the values that colours show: their default range and a histogram.

use surfel::geometry::ValueRange;

/// Maximum number of bins of a histogram.
const BINS: usize = 64;
/// How far a histogram reaches beyond the default range, as a part of that, if there are values.
const BEYOND: f64 = 0.25;
/// Largest whole number below which all whole numbers are exact.
const LARGEST_EXACT: f64 = (1u64 << 53) as f64;

/// The distribution of finite values.
#[derive(Clone, Debug, PartialEq)]
pub struct Distribution {
    /// The default range: from the 1st to the 99th percentile.
    pub range: ValueRange,
    /// The values at the start of the first bin and at the end of the last.
    pub domain: ValueRange,
    /// Number of values in each bin; bins are equally wide.
    pub counts: Vec<u64>,
    /// Number of values before the first bin and after the last.
    pub outside: [u64; 2],
}

impl Distribution {
    /// Of the finite values; `None` if there are none. Bins of whole numbers hold equally many of them.
    pub fn of(values: impl Iterator<Item = f64> + Clone) -> Option<Self> {
        let (range, _) = ValueRange::of(values.clone())?;
        let finite = || values.clone().filter(|value| value.is_finite());
        let [least, greatest] =
            finite().fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], value| [a.min(value), b.max(value)]);
        let beyond = BEYOND * (range.max - range.min);
        // The default range of values of which nearly all are equal has no width.
        let (start, end) = if beyond > 0.0 {
            (least.max(range.min - beyond), greatest.min(range.max + beyond))
        } else {
            (least, greatest)
        };
        let are_whole = end - start < LARGEST_EXACT && finite().all(|value| value.fract() == 0.0);
        let (domain, bins) =
            if are_whole { whole(start, end) } else { (ValueRange { min: start, max: end }, BINS) };
        let (mut counts, mut outside) = (vec![0; bins], [0; 2]);
        for value in finite() {
            if value < domain.min {
                outside[0] += 1;
            } else if value > domain.max {
                outside[1] += 1;
            } else {
                let bin = (domain.share(value) * bins as f64) as usize;
                counts[bin.min(bins - 1)] += 1;
            }
        }
        Some(Self { range, domain, counts, outside })
    }

    /// The values at both ends of a bin.
    pub fn bin(&self, index: usize) -> [f64; 2] {
        let ValueRange { min, max } = self.domain;
        let at = |index: usize| {
            let part = index as f64 / self.counts.len() as f64;
            min * (1.0 - part) + max * part
        };
        [at(index), at(index + 1)]
    }

    /// The parts of all values that are below and above a range; within a bin, values count as evenly spread.
    pub fn clipped(&self, range: &ValueRange) -> [f64; 2] {
        let all: u64 = self.counts.iter().chain(&self.outside).sum();
        let [mut below, mut above] = self.outside.map(|count| count as f64);
        for (index, count) in self.counts.iter().enumerate() {
            let [min, max] = self.bin(index);
            let bin = ValueRange { min, max };
            below += *count as f64 * bin.share(range.min).clamp(0.0, 1.0);
            above += *count as f64 * (1.0 - bin.share(range.max)).clamp(0.0, 1.0);
        }
        [below, above].map(|count| count / all as f64)
    }
}

/// The domain and the number of bins of whole numbers from `start` to `end`, whose middles are whole or half numbers.
fn whole(start: f64, end: f64) -> (ValueRange, usize) {
    let numbers = end.floor() - start.ceil() + 1.0;
    let each = (numbers / BINS as f64).ceil().max(1.0);
    let bins = (numbers / each).ceil().clamp(1.0, BINS as f64);
    let min = start.ceil() - 0.5;
    (ValueRange { min, max: min + bins * each }, bins as usize)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(values: &[f64]) -> Distribution {
        Distribution::of(values.iter().copied()).unwrap()
    }

    #[test]
    fn every_finite_value_is_counted_once() {
        let mut values: Vec<f64> = (0..1000).map(|i| f64::from(i) * 0.01).collect();
        values.extend([f64::NAN, f64::INFINITY, -1e6, 1e6, 1e7]);
        let found = of(&values);
        assert_eq!(found.outside, [1, 2], "stray values do not squeeze the others into one bin");
        assert_eq!(found.counts.iter().sum::<u64>(), 1000);
        assert_eq!(found.counts.len(), BINS);
        assert!(found.domain.min < found.range.min && found.domain.max > found.range.max);
        assert!(found.counts.iter().all(|count| *count <= 25), "{:?}", found.counts);
        for (index, count) in found.counts.iter().enumerate() {
            let [start, end] = found.bin(index);
            let within = values.iter().filter(|value| **value >= start && **value < end).count() as u64;
            assert!(within.abs_diff(*count) <= 1, "{index}: {within} of {count}");
        }
    }

    #[test]
    fn bins_of_whole_numbers_hold_equally_many_of_them() {
        // 200 numbers in 64 equal bins would alternate between 3 and 4.
        let found = of(&(0..200).map(f64::from).collect::<Vec<_>>());
        assert_eq!((found.counts.len(), found.outside), (50, [0, 0]));
        assert!(found.counts.iter().all(|count| *count == 4), "{:?}", found.counts);
        let classes = of(&[2.0, 2.0, 2.0, 5.0, 6.0]);
        assert_eq!(
            (classes.counts, classes.domain),
            (vec![3, 0, 0, 1, 1], ValueRange { min: 1.5, max: 6.5 })
        );
    }

    #[test]
    fn any_values_have_a_distribution_but_none() {
        assert_eq!(Distribution::of([f64::NAN].into_iter()), None);
        for values in [&[0.5; 3][..], &[7.0], &[1e300, 1e300], &[-f64::MAX, f64::MAX], &[0.0, 5e-324]] {
            let found = of(values);
            let counted = found.counts.iter().chain(&found.outside).sum::<u64>();
            assert_eq!(counted, values.len() as u64, "{values:?}");
            assert!(found.counts.len() <= BINS, "{values:?}");
        }
        // A range without a width: nearly all values are equal.
        let flat = of(&[vec![0.25; 500], vec![1.5]].concat());
        assert_eq!((flat.counts[0], flat.counts[BINS - 1]), (500, 1));
    }

    #[test]
    fn values_beyond_a_range_are_clipped() {
        let found = of(&(0..100).map(f64::from).collect::<Vec<_>>());
        let clipped = |min, max| found.clipped(&ValueRange { min, max });
        assert_eq!(clipped(-1.0, 200.0), [0.0, 0.0]);
        for (range, parts) in [((19.5, 79.5), [0.2, 0.2]), ((20.5, 80.5), [0.21, 0.19])] {
            let [below, above] = clipped(range.0, range.1);
            assert!((below - parts[0]).abs() < 1e-9 && (above - parts[1]).abs() < 1e-9, "{below} {above}");
        }
    }
}
