//! The window of `surfel view`: a host of the engine that uses its public interface alone.
//!
//! ```text
//! loader, on its own thread ─→ scene ─┐
//! input ─ orbit → camera ─────────────┴─ split view → window
//! ```
#![forbid(unsafe_code)]

mod adaptive_resolution;
mod app;
mod appearance;
mod cached_view;
mod choices;
mod comparison;
mod depths;
mod directions;
mod distribution;
mod events;
mod exact_surface;
mod hud;
mod input;
mod job;
mod keys;
mod layout;
mod levels;
mod load;
mod open_dialog;
mod orbit;
mod panels;
mod quality;
mod retry;
mod saved_settings;
mod scene_info;
mod scene_view;
mod screenshots;
mod source;
mod split_view;
mod state;
mod style;
mod viewport;
mod watch;
mod window;

pub use events::Events;
pub use exact_surface::{ExactSurface, OpenSurface};
use glam::DVec3;
pub use load::{Load, LoadListener};
pub use scene_info::SceneInfo;
pub use screenshots::SaveFolder;
use std::ffi::OsString;
use std::path::PathBuf;
use std::sync::Arc;
use surfel::formats::Filter;
use surfel::frame::faster::FasterRasterizers;
use surfel::geometry::{ColourMap, Extent, Model, Pose, SurfelFormat, ValueRange};
use surfel::settings::Shading;
use surfel::settings::methods::Method;
use surfel::vk::{Device, DeviceOptions};
use surfel::{Error, Progress, Rasterizer, RasterizerChoice, Result, Settings};

/// Options of the window.
pub struct Options {
    /// Files and built-in scenes to load first; may be empty.
    pub inputs: Vec<OsString>,
    /// Which points of files are read, until the panel changes it for a scene.
    pub filter: Filter,
    /// Width and height of the window, px.
    pub size: [u32; 2],
    /// Which device renders and presents.
    pub device: DeviceOptions,
    /// The required rasterizer.
    pub rasterizer: Option<Rasterizer>,
    /// The faster rasterizers of devices.
    pub faster: FasterRasterizers,
    /// Time budget of a frame while the camera moves, ms.
    pub budget: f64,
    /// Vertical angle of view, unless the camera has its own, degrees.
    pub fov_y_deg: f64,
    /// The camera of the first scene.
    pub initial_camera: InitialCamera,
    /// Whether files are loaded again when they change.
    pub watch: bool,
    /// The log of events.
    pub events: Events,
    /// Where screenshots and cameras are saved.
    pub save_folder: SaveFolder,
    /// What to do about an error, for the end of its message; may be empty.
    pub remedy: fn(&Error) -> &'static str,
    /// The file of saved settings, if there is one.
    pub settings_file: Option<PathBuf>,
    /// Whether the user chose a method or changed its settings: saved settings do not apply then.
    pub method_chosen: bool,
}

impl Options {
    /// Choice of the rasterizer on a device.
    fn rasterizer_on(&self, device: &Device) -> RasterizerChoice {
        self.faster.choice(self.rasterizer, device.description())
    }
}

/// What is loaded as one scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoadRequest {
    /// Files and built-in scenes.
    pub inputs: Vec<OsString>,
    /// Which points of the files are read.
    pub filter: Filter,
}

/// A scene that was loaded, and how it is first shown.
pub struct Loaded {
    /// The scene.
    pub model: Model,
    /// The exact surface; or a sentence for the user: why there is none, and the remedy.
    pub surface: std::result::Result<ExactSurface, String>,
    /// Further properties of the points; `None` for a preview.
    pub properties: Option<PointProperties>,
    /// What the points are first coloured by, if not by their own colours.
    pub colour_by: Option<ColourBy>,
    /// The first method.
    pub method: Method,
    /// What the scene is first shaded by, instead of the usual shading; `None` for that.
    pub shading: Option<Shading>,
    /// The first strength of ambient occlusion, instead of the usual one; `None` for that.
    pub ao: Option<f32>,
    /// Format in which the device stores the surfels.
    pub format: SurfelFormat,
    /// Information for the user.
    pub info: SceneInfo,
    /// Up direction of the world, a unit vector; the camera takes the nearest axis.
    pub up: DVec3,
}

impl Loaded {
    /// A scene without further information; y is up.
    pub fn new(model: Model, method: Method) -> Self {
        Self {
            model,
            surface: Err("No exact surface of a preview: wait until all points are loaded.".into()),
            properties: None,
            colour_by: None,
            method,
            shading: None,
            ao: None,
            format: SurfelFormat::default(),
            info: SceneInfo::default(),
            up: DVec3::Y,
        }
    }
}

/// What points are coloured by.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourBy {
    /// Name of an attribute or of a property of the files.
    pub name: String,
    /// The colour map.
    pub map: ColourMap,
    /// The values at both ends of the colour map; the default range if `None`.
    pub range: Option<ValueRange>,
}

/// Makes the first camera for the extent of a scene and a picture of this width and height, px; `None` frames the whole scene.
pub type InitialCamera = Box<dyn Fn(&Extent, DVec3, [u32; 2]) -> Option<Result<Pose>>>;

/// Properties of points that the scene itself does not use, for colours to show.
#[derive(Clone)]
pub struct PointProperties {
    /// Their names.
    pub names: Vec<String>,
    /// Reads the property of a name.
    pub read: ReadProperty,
}

/// Reads a property: its values of every surfel, and of every vertex of lines and triangles; NaN where there is none.
pub type ReadProperty = Arc<dyn Fn(&str, &dyn Progress) -> Result<[Vec<f32>; 2]> + Send + Sync>;

/// The settings of a method.
pub type MethodSettings = Box<dyn Fn(&Method) -> Settings>;

/// Opens the window and runs it until the user closes it. It shows what `load` makes of the inputs, and of files dropped on it; errors of loading
/// are messages in the window.
///
/// # Errors
/// [`surfel::Error::NoWindow`] without a display, [`surfel::Error::NoDevice`] without a device; errors of rendering.
pub fn run(options: Options, load: Load, method_settings: MethodSettings) -> Result<()> {
    app::run(options, load, method_settings)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;
    use surfel::vk::{Device, DeviceOptions};

    /// A device with the validation layers. Without one the test is skipped with a note, or fails if `SURFEL_REQUIRE_GPU` is 1.
    pub fn device(test: &str) -> Option<Arc<Device>> {
        match Device::open(&DeviceOptions { validate: true, ..Default::default() }) {
            Ok(device) => Some(device),
            Err(error) => {
                assert_ne!(std::env::var("SURFEL_REQUIRE_GPU").as_deref(), Ok("1"), "{test}: {error}");
                crate::skipping::say_skipped(&error.to_string());
                None
            }
        }
    }
}
