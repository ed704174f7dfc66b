//! How much of a file has been read.

use crate::Progress;
use crate::formats::source::Parsed;
use std::sync::atomic::{AtomicU64, Ordering};

/// Adds up the bytes that several threads have read.
pub(super) struct Meter<'a> {
    progress: &'a dyn Progress,
    total: u64,
    done: AtomicU64,
}

impl<'a> Meter<'a> {
    /// Of a file of `total` bytes.
    pub fn new(progress: &'a dyn Progress, total: u64) -> Self {
        progress.at("reading", 0, total);
        Self { progress, total, done: AtomicU64::new(0) }
    }

    /// Some bytes have been read, perhaps not for the first time; the end is left to [`Meter::finish`]. An error if nobody wants more.
    pub fn add(&self, bytes: u64) -> Parsed<()> {
        let done = self.done.fetch_add(bytes, Ordering::Relaxed).saturating_add(bytes);
        if done < self.total {
            self.progress.at("reading", done, self.total);
        }
        self.progress.check_cancelled()
    }

    /// All of the file has been read.
    pub fn finish(&self) {
        self.progress.at("reading", self.total, self.total);
    }
}
