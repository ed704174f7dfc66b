//! Progress of a frame, and its cancellation.

use crate::Progress;
use std::sync::atomic::{AtomicU64, Ordering};

/// Name of the stage that is reported.
const STAGE: &str = "reconstructing";

/// Progress of the passes over pixels.
pub struct PassProgress<'a> {
    progress: &'a dyn Progress,
    done: AtomicU64,
    /// Pixels of all passes.
    total: u64,
}

impl<'a> PassProgress<'a> {
    /// Progress of passes over `total` pixels.
    pub fn new(progress: &'a dyn Progress, total: u64) -> Self {
        progress.at(STAGE, 0, total);
        Self { progress, done: AtomicU64::new(0), total }
    }

    /// Reports to nobody.
    pub fn silent() -> Self {
        Self::new(&(), 0)
    }

    /// Reports `pixels` more.
    pub fn advance(&self, pixels: u64) {
        let done = self.done.fetch_add(pixels, Ordering::Relaxed) + pixels;
        self.progress.at(STAGE, done, self.total);
    }

    /// Whether the frame is cancelled.
    pub fn is_cancelled(&self) -> bool {
        self.progress.is_cancelled()
    }
}
