//! Limits how often a lost device is replaced.

use std::time::{Duration, Instant};

/// How long a device must have worked for its loss to count as a new one; sooner, the cause of the last loss persists.
const STABLE: Duration = Duration::from_secs(60);

/// Allows one replacement per loss.
#[derive(Clone, Copy, Debug, Default)]
pub struct Retry {
    lost: Option<Instant>,
}

impl Retry {
    /// Notes the loss of the device; returns whether another one may be opened.
    pub fn is_allowed(&mut self, now: Instant) -> bool {
        let stable = self.lost.is_none_or(|before| now > before + STABLE);
        self.lost = Some(now);
        stable
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_is_retried_once_and_again_after_a_stable_time() {
        let (mut retry, start) = (Retry::default(), Instant::now());
        let mut lost = |seconds| retry.is_allowed(start + Duration::from_secs(seconds));
        assert_eq!([0, 5, 64, 130, 131].map(&mut lost), [true, false, false, true, false]);
    }
}
