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
pub struct Statistics {
    /// Median; the mean of the two middle values of an even number.
    pub median: f64,
    /// Least.
    pub min: f64,
    /// Greatest.
    pub max: f64,
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
        Some(Self { median, min, max })
    }
}

/// A table with a line per pass.
impl fmt::Display for Times {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{:<16}{:>12}{:>12}{:>12}  ms", "pass", "median", "min", "max")?;
        let frame = self.frame().map(|times| ("frame (CPU)", times));
        self.passes().chain(frame).try_for_each(|(label, Statistics { median, min, max })| {
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
        assert_eq!(three.frame(), Some(Statistics { median: 4.0, min: 2.0, max: 9.0 }));
        let passes: Vec<_> = three.passes().collect();
        assert_eq!(passes, [("footprint", Statistics { median: 2.0, min: 1.0, max: 4.5 })]);
        assert_eq!(times(&[7]).frame().map(|frame| frame.max), Some(7.0));
        assert_eq!(times(&[100, 1, 2]).frame().map(|frame| frame.median), Some(1.5));
        assert_eq!(times(&[]).frame(), None);
    }

    #[test]
    fn the_table_has_a_line_a_pass_and_one_for_the_frame() {
        let table = times(&[2, 3]).to_string();
        let starts: Vec<_> = table.lines().map(|line| line.split_whitespace().next().unwrap()).collect();
        assert_eq!(starts, ["pass", "footprint", "frame"]);
        assert!(table.contains("1.500") && table.contains("3.000") && !table.contains("2.000"), "{table}");
    }
}
