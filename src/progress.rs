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

impl dyn Progress + '_ {
    /// Fails where the work is to be given up.
    pub(crate) fn go_on(&self) -> Result<(), String> {
        if self.is_cancelled() { Err(crate::Error::Cancelled.to_string()) } else { Ok(()) }
    }

    /// Why work on an input failed: because it was given up, or of `cause`.
    pub(crate) fn failed(&self, name: impl Into<String>, cause: String) -> crate::Error {
        if self.is_cancelled() { crate::Error::Cancelled } else { crate::Error::input(name, cause) }
    }
}

/// Nobody is told.
impl Progress for () {
    fn at(&self, _: &'static str, _: u64, _: u64) {}
}
