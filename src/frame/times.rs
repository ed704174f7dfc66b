//! Statistics of frame and pass times.

use crate::vk::PassTime;
use std::fmt;
use std::time::Duration;

/// Times of the frames of a command.
#[derive(Clone, Debug, Default)]
pub struct Times {
    /// Frames added, with the warm-up.
    added: usize,
    /// Milliseconds of measured frames.
    frames: Vec<f64>,
    passes: Vec<(&'static str, Vec<f64>)>,
}

/// Statistics over measured frames, ms.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bench", derive(schemars::JsonSchema))]
pub struct Statistics {
    /// Median; the mean of the two middle values of an even number.
    pub median: f64,
    /// Least.
    pub min: f64,
    /// Greatest.
    pub max: f64,
    /// The 95 % confidence interval of the median, by the sign test: see [`Interval`]. `None` of fewer than [six](FEWEST) values.
    #[cfg_attr(feature = "serde", serde(default))]
    pub interval: Option<[f64; 2]>,
}

/// Fewest values that give a 95 % interval: the median is outside of those of fewer with a probability above 5 %.
pub const FEWEST: usize = 6;

/// Median with its 95 % confidence interval.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "bench", derive(schemars::JsonSchema))]
pub struct Interval {
    /// Median.
    pub median: f64,
    /// Least value of the interval.
    pub low: f64,
    /// Greatest value of the interval.
    pub high: f64,
}

impl Interval {
    /// Interval between two of the values, by the sign test: whatever their distribution, the median is outside with a probability of at most
    /// 5 %. Fewer than six values do not suffice: it is then from the least to the greatest. `None` without values.
    pub fn of(values: &[f64]) -> Option<Self> {
        let Statistics { median, min, max, interval } = Statistics::of(values)?;
        let [low, high] = interval.unwrap_or([min, max]);
        Some(Self { median, low, high })
    }
}

/// The most of `count` sorted values, on each side, that may lie outside of the interval: at most so many are below the median with a
/// probability of at most 2.5 %.
fn values_outside(count: usize) -> usize {
    // Logarithm of the probability that so many are below, by the binomial distribution with p = 1/2.
    let mut logarithm = count as f64 * 0.5f64.ln();
    let mut sum = 0.0;
    for below in 0..count / 2 {
        sum += logarithm.exp();
        if sum > 0.025 {
            return below.saturating_sub(1);
        }
        logarithm += ((count - below) as f64 / (below + 1) as f64).ln();
    }
    0
}

impl Times {
    /// Adds a frame: the time that its caller waited, and its passes on the GPU.
    ///
    /// The second frame discards the first, a warm-up that creates pipelines and targets.
    pub fn add(&mut self, frame: Duration, passes: &[PassTime]) {
        self.added += 1;
        if self.added == 2 {
            self.frames.clear();
            self.passes.clear();
        }
        self.frames.push(frame.as_secs_f64() * 1e3);
        for pass in passes {
            match self.passes.iter_mut().find(|(label, _)| *label == pass.label) {
                Some((_, times)) => times.push(pass.milliseconds),
                None => self.passes.push((pass.label, vec![pass.milliseconds])),
            }
        }
    }

    /// Number of measured frames.
    pub fn count(&self) -> usize {
        self.frames.len()
    }

    /// Whole frames, as their caller waited.
    pub fn frame(&self) -> Option<Statistics> {
        Statistics::of(&self.frames)
    }

    /// Passes on the GPU, in their order; empty without timestamps.
    pub fn passes(&self) -> impl Iterator<Item = (&'static str, Statistics)> {
        self.passes.iter().filter_map(|(label, times)| Some((*label, Statistics::of(times)?)))
    }
}

impl Statistics {
    /// Statistics of unsorted milliseconds; `None` if empty.
    pub fn of(times: &[f64]) -> Option<Self> {
        let mut sorted = times.to_vec();
        sorted.sort_by(f64::total_cmp);
        let (min, max) = (*sorted.first()?, *sorted.last()?);
        let median = 0.5 * (sorted[(sorted.len() - 1) / 2] + sorted[sorted.len() / 2]);
        let interval = (sorted.len() >= FEWEST).then(|| {
            let out = values_outside(sorted.len());
            [sorted[out], sorted[sorted.len() - 1 - out]]
        });
        Some(Self { median, min, max, interval })
    }
}

/// A table with a line per pass.
impl fmt::Display for Times {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<16}{:>12}{:>12}{:>12}  ms", "pass", "median", "min", "max")?;
        let frame = self.frame().map(|times| ("frame (wall)", times));
        self.passes().chain(frame).try_for_each(|(label, Statistics { median, min, max, .. })| {
            writeln!(f, "{label:<16}{median:>12.3}{min:>12.3}{max:>12.3}")
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn times(frames: &[u64]) -> Times {
        let mut times = Times::default();
        for &ms in frames {
            let pass = PassTime { label: "footprint", milliseconds: 0.5 * ms as f64 };
            times.add(Duration::from_millis(ms), &[pass]);
        }
        times
    }

    #[test]
    fn the_first_of_several_frames_does_not_count() {
        let three = times(&[100, 4, 2, 9]);
        assert_eq!(three.frame(), Some(Statistics { median: 4.0, min: 2.0, max: 9.0, interval: None }));
        let passes: Vec<_> = three.passes().collect();
        assert_eq!(passes, [("footprint", Statistics { median: 2.0, min: 1.0, max: 4.5, interval: None })]);
        assert_eq!(times(&[7]).frame().map(|frame| frame.max), Some(7.0));
        assert_eq!(times(&[100, 1, 2]).frame().map(|frame| frame.median), Some(1.5));
        assert_eq!(times(&[]).frame(), None);
    }

    #[test]
    fn intervals_of_medians_are_those_of_the_sign_test() {
        let of = |count: i32| Interval::of(&(1..=count).rev().map(f64::from).collect::<Vec<_>>());
        assert_eq!(of(0), None);
        // Tabulated ranks (Conover, Practical Nonparametric Statistics, table A3).
        for (count, low) in
            [(1, 1.0), (5, 1.0), (6, 1.0), (8, 1.0), (9, 2.0), (10, 2.0), (12, 3.0), (20, 6.0), (30, 10.0)]
        {
            let high = f64::from(count + 1) - low;
            let expected = Interval { median: 0.5 * f64::from(count + 1), low, high };
            assert_eq!(of(count), Some(expected));
        }
        let many = of(5000).unwrap();
        assert!(many.low > 2400.0 && many.low < 2500.0, "{many:?}");
    }

    #[test]
    fn fewer_than_six_values_have_no_interval() {
        let of = |count: usize| Statistics::of(&[1.0, 2.0, 3.0, 4.0, 5.0, 6.0][..count]).unwrap().interval;
        assert_eq!([1, 3, 5, 6].map(of), [None, None, None, Some([1.0, 6.0])]);
    }

    #[test]
    fn the_table_has_a_line_a_pass_and_one_for_the_frame() {
        let table = times(&[2, 3]).to_string();
        let starts: Vec<_> = table.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
        assert_eq!(starts, ["pass", "footprint", "frame"]);
        assert!(table.contains("1.500") && table.contains("3.000") && !table.contains("2.000"), "{table}");
    }
}
