//! What happens in the window, one JSON object a line on standard output, for programs that wait for it.

use crate::camera_file::Fields;
use serde::Serialize;
use std::io::Write;
use std::path::Path;
use std::time::Instant;

/// Something that has happened.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum Event<'a> {
    /// The window is open, on this device.
    Window { device: &'a str },
    /// A scene is on the device, and is shown from now on.
    Ready { surfels: u64 },
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
    /// Of the window's picture, px.
    pub size: [u32; 2],
    /// Side of what was drawn, as part of the window's: 1 is the whole picture.
    pub side: f64,
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
        let ms = (1e6 * self.start.elapsed().as_secs_f64()).round() / 1e3;
        let Ok(mut line) = serde_json::to_string(&Line { ms, event }) else { return };
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
        let line = serde_json::to_string(&Line { ms: 1.5, event: &event }).unwrap();
        assert_eq!(line, r#"{"ms":1.5,"event":"wrote","file":"a b.png"}"#);
        let line = serde_json::to_string(&Line { ms: 2.0, event: &Event::Copied }).unwrap();
        assert_eq!(line, r#"{"ms":2.0,"event":"copied"}"#);
    }
}
