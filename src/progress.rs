//! Progress and cancellation of long operations, and counts in what people read of them.

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

/// A count with separators of thousands: `1,234,567`.
pub fn thousands(count: u64) -> String {
    let digits = count.to_string();
    let (first, rest) = digits.split_at(digits.len() % 3);
    let groups = rest.as_bytes().chunks(3).map(|group| String::from_utf8_lossy(group).into_owned());
    let all = Some(first.to_owned()).filter(|first| !first.is_empty()).into_iter().chain(groups);
    all.collect::<Vec<_>>().join(",")
}

#[cfg(test)]
mod tests {
    use super::thousands;

    #[test]
    fn groups_of_three_digits_are_separated() {
        let texts = [0, 7, 999, 1000, 35_947, 100_000, 1_234_567, u64::MAX].map(thousands);
        let expected =
            ["0", "7", "999", "1,000", "35,947", "100,000", "1,234,567", "18,446,744,073,709,551,615"];
        assert_eq!(texts, expected);
    }
}
