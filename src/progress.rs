//! Progress and cancellation of long operations.

use crate::error::Cause;

/// Receives the progress of a long operation. Its methods are called often and from any thread, and must not block.
pub trait Progress: Sync {
    /// Reports that `done` of `total` units of `stage` are complete. A stage begins with its first call and ends with `done == total`.
    fn at(&self, stage: &'static str, done: u64, total: u64);

    /// Whether to cancel the operation: operations that support this then return [`Error::Cancelled`](crate::Error::Cancelled).
    fn is_cancelled(&self) -> bool {
        false
    }
}

impl dyn Progress + '_ {
    /// Returns an error if the operation is cancelled.
    pub(crate) fn check_cancelled(&self) -> Result<(), Cause> {
        if self.is_cancelled() { Err(Cause::Cancelled) } else { Ok(()) }
    }
}

/// Ignores progress.
impl Progress for () {
    fn at(&self, _: &'static str, _: u64, _: u64) {}
}
