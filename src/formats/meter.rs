//! Progress of reading a file.

use super::source::Parsed;
use crate::Progress;
use std::sync::atomic::{AtomicU64, Ordering};

/// Sums the bytes that several threads have read.
pub(super) struct Meter<'a> {
    progress: &'a dyn Progress,
    total: u64,
    done: AtomicU64,
}

impl<'a> Meter<'a> {
    /// Starts the progress of a file of `total` bytes.
    pub fn new(progress: &'a dyn Progress, total: u64) -> Self {
        progress.at("reading", 0, total);
        Self { progress, total, done: AtomicU64::new(0) }
    }

    /// Adds bytes, possibly read before; [`Meter::finish`] reports the end. Returns an error if the operation is cancelled.
    pub fn add(&self, bytes: u64) -> Parsed<()> {
        let done = self.done.fetch_add(bytes, Ordering::Relaxed).saturating_add(bytes);
        if done < self.total {
            self.progress.at("reading", done, self.total);
        }
        self.progress.check_cancelled()
    }

    /// Reports that the whole file is read.
    pub fn finish(&self) {
        self.progress.at("reading", self.total, self.total);
    }
}
