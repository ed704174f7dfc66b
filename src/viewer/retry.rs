//! What happens when the device is lost: another one is opened, unless that helped as little just before.

use std::time::{Duration, Instant};

/// How long a device has to have served before its loss is a new one, and not the last one's cause at work again.
const CALM: Duration = Duration::from_secs(60);

/// Grants one retry.
#[derive(Clone, Copy, Debug, Default)]
pub struct Retry {
    lost: Option<Instant>,
}

impl Retry {
    /// The device is lost; whether another one is to be opened.
    pub fn lost(&mut self, now: Instant) -> bool {
        let calm = self.lost.is_none_or(|before| now > before + CALM);
        self.lost = Some(now);
        calm
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_is_retried_once_and_again_after_a_calm_time() {
        let (mut retry, start) = (Retry::default(), Instant::now());
        let mut lost = |seconds| retry.lost(start + Duration::from_secs(seconds));
        assert_eq!([0, 5, 64, 130, 131].map(&mut lost), [true, false, false, true, false]);
    }
}
