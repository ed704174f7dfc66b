//! Progress of reading or writing a file.

use super::source::Parsed;
use crate::Progress;
use std::sync::atomic::{AtomicU64, Ordering};

/// Sums what several threads have read or written.
pub(super) struct Meter<'a> {
    stage: &'static str,
    progress: &'a dyn Progress,
    total: u64,
    done: AtomicU64,
}

impl<'a> Meter<'a> {
    /// Starts the progress of reading a file of `total` bytes.
    pub fn new(progress: &'a dyn Progress, total: u64) -> Self {
        Self::of_stage("reading", progress, total)
    }

    /// Starts the progress of writing a file of `total` points.
    #[cfg(any(feature = "e57", feature = "las"))]
    pub fn of_writing(progress: &'a dyn Progress, total: u64) -> Self {
        Self::of_stage("writing", progress, total)
    }

    fn of_stage(stage: &'static str, progress: &'a dyn Progress, total: u64) -> Self {
        progress.at(stage, 0, total);
        Self { stage, progress, total, done: AtomicU64::new(0) }
    }

    /// Adds bytes, possibly read before, or points; [`Meter::finish`] reports the end. Returns an error if the operation is cancelled.
    pub fn add(&self, bytes: u64) -> Parsed<()> {
        let done = self.done.fetch_add(bytes, Ordering::Relaxed).saturating_add(bytes);
        if done < self.total {
            self.progress.at(self.stage, done, self.total);
        }
        self.progress.check_cancelled()
    }

    /// Reports that the whole file is read or written.
    pub fn finish(&self) {
        self.progress.at(self.stage, self.total, self.total);
    }
}
