//! Who is told how far a frame has come, and may give it up.

use crate::Progress;
use std::sync::atomic::{AtomicU64, Ordering};

/// What is told of the passes over pixels.
pub struct Watch<'a> {
    progress: &'a dyn Progress,
    done: AtomicU64,
    /// Pixels of all passes.
    total: u64,
}

impl<'a> Watch<'a> {
    /// Of passes that make so many pixels.
    pub fn new(progress: &'a dyn Progress, total: u64) -> Self {
        let watch = Self { progress, done: AtomicU64::new(0), total };
        watch.made(0);
        watch
    }

    /// Nobody is told.
    pub fn nobody() -> Self {
        Self::new(&(), 0)
    }

    /// So many pixels more are made.
    pub fn made(&self, pixels: u64) {
        let done = self.done.fetch_add(pixels, Ordering::Relaxed) + pixels;
        self.progress.at("reconstructing", done, self.total);
    }

    /// Whether nobody sees the frame any more.
    pub fn is_over(&self) -> bool {
        self.progress.is_cancelled()
    }
}
