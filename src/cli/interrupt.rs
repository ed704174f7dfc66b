//! Ctrl-C, for operations that can be continued later.

use super::progress::say;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use surfel::{Error, Progress, Result};

/// Whether the user has asked to end.
static ASKED: AtomicBool = AtomicBool::new(false);

/// Exit status of a program that SIGINT ends.
const STATUS: i32 = 130;

/// From now on the first Ctrl-C, or SIGTERM, cancels what observes [`Interruptible`]; the next one ends the program at once.
///
/// # Errors
/// [`Error::Usage`] if the handler cannot be installed.
pub fn catch() -> Result<()> {
    let handler = || {
        if ASKED.swap(true, Relaxed) {
            std::process::exit(STATUS);
        }
        say("surfel: ends after the present group of runs; again to end at once");
    };
    ctrlc::set_handler(handler).map_err(|error| Error::Usage(format!("cannot catch Ctrl-C: {error}")))
}

/// Progress of an operation that Ctrl-C cancels.
pub struct Interruptible<'a>(pub &'a dyn Progress);

impl Progress for Interruptible<'_> {
    fn at(&self, stage: &'static str, done: u64, total: u64) {
        self.0.at(stage, done, total);
    }

    fn is_cancelled(&self) -> bool {
        ASKED.load(Relaxed) || self.0.is_cancelled()
    }
}
