//! The window of `surfel view`: a host of the engine that uses its public interface alone.
//!
//! ```text
//! load, on a thread of its own ─→ scene ─┐
//! input ─ orbit → camera ────────────────┴─ screen → window
//! ```
#![forbid(unsafe_code)]

mod about;
mod adaptive_resolution;
mod app;
mod cached_view;
mod cost;
mod events;
mod hud;
mod input;
mod job;
mod keys;
mod layout;
mod load;
mod open;
mod orbit;
mod panels;
mod quality;
mod remember;
mod retry;
mod screenshots;
mod source;
mod split_view;
mod state;
mod style;
mod viewport;
mod watch;
mod window;

pub use about::About;
pub use events::Events;
use glam::DVec3;
pub use load::{Load, Loading};
pub use screenshots::SaveFolder;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use surfel::geometry::{Bounds, ColourMap, Model, Pose, ValueRange};
use surfel::settings::methods::Method;
use surfel::vk::DeviceOptions;
use surfel::{Progress, Rasterizer, Result, Settings};

/// How the window is opened.
pub struct Options {
    /// Files and scenes that are looked at first; there may be none.
    pub inputs: Vec<OsString>,
    /// Width and height of the window, px.
    pub size: [u32; 2],
    /// Which device renders and presents.
    pub device: DeviceOptions,
    /// What visits the pixels; `None` takes what is faster on the device.
    pub rasterizer: Option<Rasterizer>,
    /// What is up in the world, of any length; the axis that is nearest is taken.
    pub up: DVec3,
    /// How long frames may take while the hands move, ms.
    pub budget: f64,
    /// Vertical angle of view where the camera does not say another, degrees.
    pub fov_y_deg: f64,
    /// Where the camera stands at first.
    pub place: Place,
    /// Whether files are loaded again when they change.
    pub watch: bool,
    /// Who is told what happens.
    pub events: Events,
    /// Where pictures and cameras are kept.
    pub save_folder: SaveFolder,
    /// Where settings are remembered, if they are.
    pub remembered: Option<PathBuf>,
    /// Whether a method or something of it is asked for, so that what is remembered of them does not count.
    pub asked: bool,
}

/// What is looked at.
pub struct Loaded {
    /// The scene.
    pub model: Model,
    /// The built-in scene that it is, if its surface is known exactly and nothing of it is changed.
    pub surface: Option<String>,
    /// What else is known of its points; of a preview nothing is.
    pub numbers: Option<Numbers>,
    /// What its points are coloured by at first, if not by their own colours.
    pub colour_by: Option<ColourBy>,
    /// How it is rendered at first.
    pub method: Method,
    /// What is known of it, for who looks.
    pub about: About,
    /// What is up in the world, a unit vector.
    pub up: DVec3,
}

impl Loaded {
    /// A scene of which nothing else is known; y is up.
    pub fn new(model: Model, method: Method) -> Self {
        Self {
            model,
            surface: None,
            numbers: None,
            colour_by: None,
            method,
            about: About::default(),
            up: DVec3::Y,
        }
    }
}

/// What points are coloured by.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBy {
    /// The quantity, or the property of the files.
    pub name: String,
    /// Which colours numbers have.
    pub map: ColourMap,
    /// The numbers at both ends of the colours; the usual range unless given.
    pub range: Option<ValueRange>,
}

/// The camera to begin with, for a scene of these bounds and a picture of this size, px; `None` shows all of it.
pub type Place = Box<dyn Fn(&Bounds, [u32; 2]) -> Option<Result<Pose>>>;

/// Numbers of points of which nothing is made, for colours to show.
#[derive(Clone)]
pub struct Numbers {
    /// Their names.
    pub names: Vec<String>,
    /// Reads those of a name.
    pub read: ReadNumbers,
}

/// Gives the numbers of a name, of every surfel, and of every vertex of lines and triangles; NaN where there is none.
pub type ReadNumbers = Arc<dyn Fn(&str, &dyn Progress) -> Result<[Vec<f32>; 2]> + Send + Sync>;

/// The settings of a method.
pub type MethodSettings = Box<dyn Fn(&Method) -> Settings>;

/// Opens the window, and shows what `load` makes of the inputs, and of files dropped on it, until it is closed. What cannot be loaded is a
/// message.
///
/// # Errors
/// [`surfel::Error::NoWindow`] where there is no display, [`surfel::Error::NoDevice`] where there is no device; whatever rendering fails with.
pub fn run(options: Options, load: Load, method_settings: MethodSettings) -> Result<()> {
    app::run(options, load, method_settings)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use surfel::vk::{Device, DeviceOptions};

    /// A device under the validation layers; `None`, said aloud, where there is none and none is required.
    pub fn device(test: &str) -> Option<Arc<Device>> {
        match Device::open(&DeviceOptions { validate: true, ..Default::default() }) {
            Ok(device) => Some(device),
            Err(error) => {
                assert_ne!(std::env::var("SURFEL_REQUIRE_GPU").as_deref(), Ok("1"), "{test}: {error}");
                eprintln!("{test}: skipped: {error}");
                None
            }
        }
    }
}
