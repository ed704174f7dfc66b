//! Files that are loaded again when they change.

use super::load::News;
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, SystemTime};
use winit::event_loop::EventLoopProxy;

/// How often files are looked at: the notifications of systems are many for one change, and none on some network drives.
const PERIOD: Duration = Duration::from_millis(250);

/// What tells one state of a file from another; `None` where there is no file.
type Mark = Option<(Option<SystemTime>, u64)>;

/// Looks at files, on a thread of its own, until it is dropped.
pub struct Watch(Sender<Vec<OsString>>);

impl Watch {
    /// Tells `window` when inputs have changed.
    pub fn new(window: EventLoopProxy<News>) -> Self {
        let (inputs, given) = channel();
        thread::spawn(move || watch(&given, || window.send_event(News::Changed).is_ok()));
        Self(inputs)
    }

    /// Looks at these from now on, as they are now.
    pub fn set_inputs(&self, inputs: &[OsString]) {
        // It looks as long as there is a sender.
        let _ = self.0.send(inputs.to_vec());
    }
}

/// Looks at what is given, and tells of changes that have come to an end, until nobody gives or hears any more.
fn watch(given: &Receiver<Vec<OsString>>, tell: impl Fn() -> bool) {
    let mut changes = Changes::default();
    loop {
        match given.recv_timeout(PERIOD) {
            Ok(inputs) => changes = Changes::of(inputs),
            Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {}
        }
        if changes.poll() && !tell() {
            return;
        }
    }
}

/// The states of files.
#[derive(Default)]
struct Changes {
    inputs: Vec<OsString>,
    /// As they were told last, and as they were seen last.
    reported: Vec<Mark>,
    seen: Vec<Mark>,
}

impl Changes {
    fn of(inputs: Vec<OsString>) -> Self {
        let now = marks(&inputs);
        Self { inputs, reported: now.clone(), seen: now }
    }

    /// Whether they are other than they were told last, and stay as they are for now: what is being written is not whole.
    fn poll(&mut self) -> bool {
        let now = marks(&self.inputs);
        let rests = std::mem::replace(&mut self.seen, now.clone()) == now;
        let changed = rests && now != self.reported && now.iter().all(Option::is_some);
        if changed {
            self.reported = now;
        }
        changed
    }
}

fn marks(inputs: &[OsString]) -> Vec<Mark> {
    inputs.iter().filter(|input| !is_scene(input)).map(|input| mark(Path::new(input))).collect()
}

/// Built-in scenes never change.
fn is_scene(input: &OsString) -> bool {
    input.to_str().is_some_and(surfel::verify::scenes::is_scene)
}

fn mark(path: &Path) -> Mark {
    let found = fs::metadata(path).ok()?;
    Some((found.modified().ok(), found.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_reported_once_when_it_is_over() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.ply");
        fs::write(&file, "a").unwrap();
        let mut changes = Changes::of(vec![file.clone().into(), "scene:sphere".into()]);
        assert!(!changes.poll() && !changes.poll());
        fs::write(&file, "ab").unwrap();
        assert!(!changes.poll(), "it may be being written");
        fs::write(&file, "abc").unwrap();
        assert!(!changes.poll());
        assert!(changes.poll());
        assert!(!changes.poll());
        // Programs that save put another file in the place of the old one: for a moment there is none.
        fs::remove_file(&file).unwrap();
        assert!(!changes.poll() && !changes.poll());
        fs::write(&file, "abcd").unwrap();
        assert_eq!([changes.poll(), changes.poll(), changes.poll()], [false, true, false]);
    }
}
