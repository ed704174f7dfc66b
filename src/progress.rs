//! How far lengthy work has come.

/// Is told how far lengthy work has come, from any thread and often: it should return at once.
pub trait Progress: Sync {
    /// `done` of `total` units of the work named `stage` are done. A stage begins with its first call and ends with `done == total`.
    fn at(&self, stage: &'static str, done: u64, total: u64);

    /// Whether the work is to be given up. Where it says that it can be, it then fails with [`Error::Cancelled`](crate::Error::Cancelled).
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// Nobody is told.
impl Progress for () {
    fn at(&self, _: &'static str, _: u64, _: u64) {}
}
