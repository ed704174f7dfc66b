//! Progress bars on standard error, and lines printed above them.

use indicatif::{MultiProgress, ProgressBar, ProgressStyle};
use std::io::{self, IsTerminal, Write};
use std::ptr;
use std::sync::atomic::{AtomicPtr, AtomicU64, Ordering::Relaxed};
use std::sync::{LazyLock, Mutex, PoisonError};
use std::time::{Duration, Instant};
use surfel::Progress;
use surfel::load::Listener;

/// Duration of a stage before its bar appears.
const PATIENCE: Duration = Duration::from_millis(500);
/// Minimum time between two updates of a bar.
const PERIOD: Duration = Duration::from_millis(80);

/// The bars on the terminal.
static BARS: LazyLock<MultiProgress> = LazyLock::new(MultiProgress::new);

/// Prints notes, and draws progress bars where standard error is a terminal; silent if `quiet`.
pub fn bars(quiet: bool) -> Box<dyn Listener> {
    if quiet {
        Box::new(())
    } else if io::stderr().is_terminal() {
        Box::new(Bars::new(PATIENCE))
    } else {
        Box::new(Notes)
    }
}

/// Prints notes only.
struct Notes;

impl Progress for Notes {
    fn at(&self, _: &'static str, _: u64, _: u64) {}
}

impl Listener for Notes {
    fn note(&self, text: &str) {
        say(text);
    }
}

/// Forwards progress only, without notes.
#[cfg(any(feature = "truth", feature = "viewer"))]
pub struct Silent<'a>(pub &'a dyn Progress);

#[cfg(any(feature = "truth", feature = "viewer"))]
impl Progress for Silent<'_> {
    fn at(&self, stage: &'static str, done: u64, total: u64) {
        self.0.at(stage, done, total);
    }

    fn is_cancelled(&self) -> bool {
        self.0.is_cancelled()
    }
}

#[cfg(any(feature = "truth", feature = "viewer"))]
impl Listener for Silent<'_> {}

/// Prints a line, or several, to standard error.
pub fn say(text: &str) {
    BARS.suspend(|| eprintln!("{text}"));
}

/// Standard error, for the log.
pub struct Log;

impl Write for Log {
    fn write(&mut self, text: &[u8]) -> io::Result<usize> {
        BARS.suspend(|| io::stderr().write(text))
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stderr().flush()
    }
}

/// A bar for the current stage, once that has lasted a while.
struct Bars {
    start: Instant,
    patience: Duration,
    /// The stage's name, readable without the lock.
    current: AtomicPtr<u8>,
    /// When the next update is due, µs after `start`.
    next: AtomicU64,
    stage: Mutex<Option<Stage>>,
}

struct Stage {
    name: &'static str,
    bar: Option<ProgressBar>,
}

impl Bars {
    fn new(patience: Duration) -> Self {
        let (current, next) = (AtomicPtr::new(ptr::null_mut()), AtomicU64::new(0));
        Self { start: Instant::now(), patience, current, next, stage: Mutex::new(None) }
    }

    /// Sets the time of the next update.
    fn wait(&self, from: Duration, time: Duration) {
        self.next.store((from + time).as_micros() as u64, Relaxed);
    }
}

impl Progress for Bars {
    fn at(&self, name: &'static str, done: u64, total: u64) {
        let now = self.start.elapsed();
        let early = (now.as_micros() as u64) < self.next.load(Relaxed);
        let label = name.as_ptr().cast_mut();
        if early && done < total && self.current.load(Relaxed) == label {
            return;
        }
        let mut stage = self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        if done >= total {
            // Another thread may report a stage late that has ended.
            if stage.as_ref().is_some_and(|stage| stage.name == name) {
                *stage = None;
                self.current.store(ptr::null_mut(), Relaxed);
            }
            return;
        }
        match &mut *stage {
            Some(stage) if stage.name == name => {
                if now.as_micros() as u64 >= self.next.load(Relaxed) {
                    stage.bar.get_or_insert_with(|| bar(name)).update(|state| {
                        state.set_len(total);
                        state.set_pos(done);
                    });
                    self.wait(now, PERIOD);
                }
            }
            _ => {
                *stage = Some(Stage { name, bar: None });
                self.wait(now, self.patience);
            }
        }
        self.current.store(label, Relaxed);
    }
}

impl Listener for Bars {
    fn note(&self, text: &str) {
        say(text);
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        if let Some(bar) = self.bar.take() {
            bar.finish_and_clear();
            BARS.remove(&bar);
        }
    }
}

fn bar(name: &'static str) -> ProgressBar {
    let style = ProgressStyle::with_template("{msg} [{bar:40}] {percent:>3} % {eta:>4}");
    let style = style.unwrap_or_else(|_| ProgressStyle::default_bar()).progress_chars("=> ");
    BARS.add(ProgressBar::new(0).with_style(style).with_message(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(bars: &Bars) -> Option<(&'static str, Option<u64>)> {
        let stage = bars.stage.lock().unwrap();
        stage.as_ref().map(|stage| (stage.name, stage.bar.as_ref().map(ProgressBar::position)))
    }

    #[test]
    fn a_stage_has_a_bar_only_after_a_while_and_until_it_ends() {
        let bars = Bars::new(Duration::from_millis(30));
        bars.at("reading", 0, 10);
        bars.at("reading", 1, 10);
        assert_eq!(shown(&bars), Some(("reading", None)));
        std::thread::sleep(Duration::from_millis(40));
        bars.at("reading", 7, 10);
        assert_eq!(shown(&bars), Some(("reading", Some(7))));
        // Too early for an update.
        bars.at("reading", 8, 10);
        assert_eq!(shown(&bars), Some(("reading", Some(7))));
        bars.at("estimating", 3, 4);
        assert_eq!(shown(&bars), Some(("estimating", None)));
        bars.at("reading", 10, 10);
        assert_eq!(shown(&bars), Some(("estimating", None)));
        bars.at("estimating", 4, 4);
        assert_eq!(shown(&bars), None);
    }
}
