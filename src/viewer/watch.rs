//! Watches files for changes, by polling.

use super::load::AppEvent;
use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, SystemTime};
use winit::event_loop::EventLoopProxy;

/// Polling period. Notifications of the operating system come several times for one change, and not at all on some network drives.
const PERIOD: Duration = Duration::from_millis(250);

/// Modification time and size of a file; `None` if there is no file.
type Mark = Option<(Option<SystemTime>, u64)>;

/// Watches files on its own thread until it is dropped.
pub struct Watcher(Sender<Vec<OsString>>);

impl Watcher {
    /// A watcher that sends [`AppEvent::FilesChanged`].
    pub fn new(proxy: EventLoopProxy<AppEvent>) -> Self {
        let (inputs, received) = channel();
        thread::spawn(move || watch(&received, || proxy.send_event(AppEvent::FilesChanged).is_ok()));
        Self(inputs)
    }

    /// Watches these inputs from now on, instead of those before.
    pub fn watch(&self, inputs: &[OsString]) {
        // The thread receives as long as there is a sender.
        let _ = self.0.send(inputs.to_vec());
    }
}

/// Watches the inputs that are received. Calls `notify` after each change, until it returns false or the sender is dropped.
fn watch(received: &Receiver<Vec<OsString>>, notify: impl Fn() -> bool) {
    let mut changes = Changes::default();
    loop {
        match received.recv_timeout(PERIOD) {
            Ok(inputs) => changes = Changes::of(inputs),
            Err(RecvTimeoutError::Disconnected) => return,
            Err(RecvTimeoutError::Timeout) => {}
        }
        if changes.poll() && !notify() {
            return;
        }
    }
}

/// The states of files.
#[derive(Default)]
struct Changes {
    inputs: Vec<OsString>,
    /// The states that were reported last, and those that were polled last.
    reported: Vec<Mark>,
    polled: Vec<Mark>,
}

impl Changes {
    fn of(inputs: Vec<OsString>) -> Self {
        let now = marks(&inputs);
        Self { inputs, reported: now.clone(), polled: now }
    }

    /// Whether the files have changed since the last report and are stable between two polls: a file that is being written is incomplete.
    fn poll(&mut self) -> bool {
        let now = marks(&self.inputs);
        let stable = std::mem::replace(&mut self.polled, now.clone()) == now;
        let changed = stable && now != self.reported && now.iter().all(Option::is_some);
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
        assert!(!changes.poll(), "it may still be written");
        fs::write(&file, "abc").unwrap();
        assert!(!changes.poll());
        assert!(changes.poll());
        assert!(!changes.poll());
        // Programs that save replace the old file: for a moment there is none.
        fs::remove_file(&file).unwrap();
        assert!(!changes.poll() && !changes.poll());
        fs::write(&file, "abcd").unwrap();
        assert_eq!([changes.poll(), changes.poll(), changes.poll()], [false, true, false]);
    }
}
