//! Event log: what happens in the window, as JSON lines on standard output, for other programs.

use cpu_time::ProcessTime;
use serde::Serialize;
use std::io::Write;
use std::path::Path;
use std::time::{Duration, Instant};
use surfel::formats::camera::Fields;

/// An event.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(tag = "event", rename_all = "kebab-case")]
pub enum Event<'a> {
    /// The window is open on this device.
    Window { device: &'a str },
    /// All inputs are read, and missing normals and radii are estimated.
    Loaded { surfels: u64 },
    /// Some of the points are on the device and are shown until all are.
    Preview { surfels: u64 },
    /// A scene is on the device and is shown from now on.
    Ready { surfels: u64 },
    /// Loading was cancelled.
    Cancelled,
    /// A picture of the scene was presented.
    Picture(PictureInfo<'a>),
    /// The error panel has compared a picture.
    Compared(ComparisonInfo<'a>),
    /// A surface point was picked, world space; `distance` is that from the one before, if there is one.
    Picked { point: [f64; 3], distance: Option<f64> },
    /// A screenshot or a camera was saved.
    Wrote { file: &'a Path },
    /// A camera was read from a file.
    Camera { file: &'a Path },
    /// The camera was copied to the clipboard.
    Copied,
    /// The window shows an error message.
    #[serde(rename = "wrong")]
    Error { error: &'a str },
    /// The device was lost; another one is opened.
    Lost,
}

/// A picture that was presented.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct PictureInfo<'a> {
    pub method: &'a str,
    pub shading: &'a str,
    /// Width and height of the window, px.
    pub size: [u32; 2],
    /// Width and height of the picture, which is the window without the panel, px.
    pub picture: [u32; 2],
    /// Resolution scale: the side of what was rendered as part of the picture's.
    #[serde(rename = "side")]
    pub scale: f64,
    /// Number of surfels.
    pub surfels: u64,
    /// Whether they are a preview.
    pub preview: bool,
    /// Whether the camera moved.
    pub moving: bool,
    /// Whether it was rendered; otherwise a cached picture was presented.
    pub drawn: bool,
    /// Duration of the frame, ms.
    pub took_ms: f64,
    /// The camera.
    pub camera: Fields,
}

/// The result of a comparison.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ComparisonInfo<'a> {
    /// What the picture was compared with.
    pub against: &'a str,
    /// Width and height of the picture, px.
    pub picture: [u32; 2],
    /// Root mean square difference, of linear colours over the background.
    pub rmse: f64,
    /// The largest difference of a channel.
    pub worst: f32,
    /// Time to render the reference or the exact picture, ms.
    pub took_ms: f64,
}

/// The event log, if it is on.
#[derive(Clone, Copy, Debug)]
pub struct Events {
    start: Instant,
    on: bool,
}

#[derive(Serialize)]
struct Line<'a> {
    /// Time since the program began, ms.
    ms: f64,
    /// Processor time of the program, ms; unlike `ms` it does not depend on other programs.
    cpu_ms: f64,
    #[serde(flatten)]
    event: &'a Event<'a>,
}

impl Events {
    /// A log whose times count from `start`; it is silent unless `on`.
    pub fn new(start: Instant, on: bool) -> Self {
        Self { start, on }
    }

    /// Logs an event.
    pub fn emit(&self, event: &Event<'_>) {
        if !self.on {
            return;
        }
        let rounded = |time: Duration| (1e6 * time.as_secs_f64()).round() / 1e3;
        let (ms, cpu_ms) = (rounded(self.start.elapsed()), rounded(ProcessTime::now().as_duration()));
        let Ok(mut line) = serde_json::to_string(&Line { ms, cpu_ms, event }) else { return };
        line.push('\n');
        let mut out = std::io::stdout().lock();
        // A closed pipe is no error: its reader wants no more.
        let _ = out.write_all(line.as_bytes()).and_then(|()| out.flush());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_event_is_a_json_line() {
        let event = Event::Wrote { file: Path::new("a b.png") };
        let line = serde_json::to_string(&Line { ms: 1.5, cpu_ms: 2.5, event: &event }).unwrap();
        assert_eq!(line, r#"{"ms":1.5,"cpu_ms":2.5,"event":"wrote","file":"a b.png"}"#);
        let line = serde_json::to_string(&Line { ms: 2.0, cpu_ms: 1.0, event: &Event::Copied }).unwrap();
        assert_eq!(line, r#"{"ms":2.0,"cpu_ms":1.0,"event":"copied"}"#);
    }
}
