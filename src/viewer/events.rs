//! What happens in the window, one JSON object a line on standard output, for programs that wait for it.

use cpu_time::ProcessTime;
use serde::Serialize;
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};
use surfel::formats::camera::Fields;

/// Something that has happened.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum Event<'a> {
    /// The window is open, on this device.
    Window { device: &'a str },
    /// All inputs are read, and what they lacked is estimated.
    Loaded { surfels: u64 },
    /// Some of the points are on the device, and are shown until all are.
    Preview { surfels: u64 },
    /// A scene is on the device, and is shown from now on.
    Ready { surfels: u64 },
    /// What is being loaded is given up.
    Cancelled,
    /// A picture of the scene went to the window.
    Picture(Shown<'a>),
    /// A picture or a camera is in a file.
    Wrote { file: &'a Path },
    /// A camera was taken from a file.
    Camera { file: &'a Path },
    /// The camera is on the clipboard.
    Copied,
    /// What the window says went wrong; what was shown before stays.
    Wrong { error: &'a str },
    /// The device was lost, and another one is opened.
    Lost,
}

/// What a picture shows.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Shown<'a> {
    pub method: &'a str,
    pub shading: &'a str,
    /// Of the window, px.
    pub size: [u32; 2],
    /// Of the picture, which is all of the window that the panel leaves, px.
    pub picture: [u32; 2],
    /// Side of what was drawn, as part of the picture's: 1 is the whole one.
    pub side: f64,
    /// How many surfels there were.
    pub surfels: u64,
    /// Whether they are some of what is being loaded.
    pub preview: bool,
    /// Whether the camera moved.
    pub moving: bool,
    /// Whether it was drawn anew, and not there already.
    pub drawn: bool,
    /// How long it took, ms.
    pub took_ms: f64,
    /// From where it is seen.
    pub camera: Fields,
}

/// Tells what happens, where somebody wants to know.
#[derive(Clone, Copy, Debug)]
pub struct Events {
    start: Instant,
    on: bool,
}

#[derive(Serialize)]
struct Line<'a> {
    /// Since the program began, ms.
    ms: f64,
    /// Processor time of the program so far, ms, which other programs do not change.
    cpu_ms: f64,
    #[serde(flatten)]
    event: &'a Event<'a>,
}

impl Events {
    /// Counts from `start`; says nothing unless `on`.
    pub fn new(start: Instant, on: bool) -> Self {
        Self { start, on }
    }

    /// Says what has happened just now.
    pub fn tell(&self, event: &Event<'_>) {
        if !self.on {
            return;
        }
        let rounded = |time: Duration| (1e6 * time.as_secs_f64()).round() / 1e3;
        let (ms, cpu_ms) = (rounded(self.start.elapsed()), rounded(ProcessTime::now().as_duration()));
        let Ok(mut line) = serde_json::to_string(&Line { ms, cpu_ms, event }) else { return };
        line.push('\n');
        let mut out = std::io::stdout().lock();
        // Whoever has stopped listening wants no more.
        let _ = out.write_all(line.as_bytes()).and_then(|()| out.flush());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_event_is_a_line_of_json() {
        let event = Event::Wrote { file: Path::new("a b.png") };
        let line = serde_json::to_string(&Line { ms: 1.5, cpu_ms: 2.5, event: &event }).unwrap();
        assert_eq!(line, r#"{"ms":1.5,"cpu_ms":2.5,"event":"wrote","file":"a b.png"}"#);
        let line = serde_json::to_string(&Line { ms: 2.0, cpu_ms: 1.0, event: &Event::Copied }).unwrap();
        assert_eq!(line, r#"{"ms":2.0,"cpu_ms":1.0,"event":"copied"}"#);
    }
}
