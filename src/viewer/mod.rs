//! The window: the first host of the engine, by its public interface alone.
//!
//! ```text
//! load, on a thread of its own ─→ scene ─┐
//! hands ─ orbit → camera ────────────────┴─ screen → window
//! ```

mod app;
mod hands;
mod hud;
mod job;
mod keys;
mod load;
mod orbit;
mod pace;
mod panels;
mod remember;
mod screen;
mod side;
mod source;
mod state;
mod window;

use glam::DVec3;
use load::Load;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use surfel::geometry::Model;
use surfel::methods::Method;
use surfel::vk::DeviceOptions;
use surfel::{Progress, Rasterizer, Result, Settings};

/// How the window is opened.
pub struct Options {
    /// Files and scenes that are looked at first.
    pub inputs: Vec<OsString>,
    /// Width and height of the picture, px.
    pub size: [u32; 2],
    /// Which device renders and presents.
    pub device: DeviceOptions,
    /// What visits the pixels; `None` takes what is faster on the device.
    pub rasterizer: Option<Rasterizer>,
    /// What is up in the world, of any length; the axis that is nearest is taken.
    pub up: DVec3,
    /// How long frames may take while the hands move, ms.
    pub budget: f64,
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
    /// What else is known of its points.
    pub numbers: Numbers,
    /// How it is rendered at first.
    pub method: Method,
}

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
pub type Look = Box<dyn Fn(&Method) -> Settings>;

/// Opens the window, and shows what `load` makes of the inputs, and of files dropped on it, until it is closed.
///
/// # Errors
/// That of `load`, if it is the first scene's; [`surfel::Error::NoDevice`] where there is no display or no device; whatever rendering fails with.
pub fn run(options: Options, load: Load, look: Look) -> Result<()> {
    app::run(options, load, look)
}
