//! Times of the stages of a frame.

use crate::vk::PassTime;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// The stages of a frame, in order, with wall times.
#[derive(Debug, Default)]
pub(super) struct Stages {
    pub times: Vec<PassTime>,
}

/// Times of stages that alternate on all threads, summed over the threads.
pub(super) struct Clock<const N: usize> {
    nanoseconds: [AtomicU64; N],
}

/// A thread's stopwatch.
pub(super) struct Lap<'a, const N: usize> {
    clock: &'a Clock<N>,
    start: Instant,
}

impl Stages {
    /// Times a stage.
    pub fn time<T>(&mut self, label: &'static str, stage: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let result = stage();
        self.times.push(PassTime { label, milliseconds: start.elapsed().as_secs_f64() * 1e3 });
        result
    }

    /// Times alternating stages: divides their common wall time in proportion to the threads' times.
    pub fn time_shared<const N: usize>(&mut self, labels: [&'static str; N], stages: impl FnOnce(&Clock<N>)) {
        let clock = Clock { nanoseconds: [const { AtomicU64::new(0) }; N] };
        let start = Instant::now();
        stages(&clock);
        let wall = start.elapsed().as_secs_f64() * 1e3;
        let busy = clock.nanoseconds.map(|nanoseconds| nanoseconds.into_inner() as f64);
        let all = busy.iter().sum::<f64>().max(1.0);
        let time = |(label, busy)| PassTime { label, milliseconds: wall * busy / all };
        self.times.extend(labels.into_iter().zip(busy).map(time));
    }
}

impl<const N: usize> Clock<N> {
    /// Starts a thread's stopwatch.
    pub fn start(&self) -> Lap<'_, N> {
        Lap { clock: self, start: Instant::now() }
    }
}

impl<const N: usize> Lap<'_, N> {
    /// Adds the time since the last call to `stage`.
    pub fn end(&mut self, stage: usize) {
        let now = Instant::now();
        let passed = now.duration_since(self.start).as_nanos() as u64;
        self.clock.nanoseconds[stage].fetch_add(passed, Ordering::Relaxed);
        self.start = now;
    }
}
