//! Options of `surfel view`.

use super::{Axes, Camera, Colours, DeviceArgs, Points, RenderSettings, inputs};
use crate::cli::values::{choice, method, number, size};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;
use surfel::settings::methods::Method;
use surfel::{Rasterizer, Result, Settings};

/// Options of `surfel view`.
#[derive(Args, Debug)]
pub struct View {
    /// Files or built-in scenes
    #[arg(value_name = "INPUT", help = inputs("several become one scene, none an empty window"))]
    pub inputs: Vec<OsString>,
    /// The first method [default: perspective-ewa; pull-push for lines or triangles]
    #[arg(long, value_parser = method())]
    pub method: Option<Method>,
    /// Changes of the method
    #[command(flatten)]
    pub axes: Axes,
    /// Size of the window with its panel, px
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size, allow_hyphen_values = true)]
    pub size: [u32; 2],
    /// How normals and radii are estimated
    #[command(flatten)]
    pub points: Points,
    /// What points are coloured by
    #[command(flatten)]
    pub colours: Colours,
    /// The first camera
    #[command(flatten)]
    pub camera: Camera,
    /// The render settings
    #[command(flatten)]
    pub render_settings: RenderSettings,
    /// The device's rasterizer, or compute shaders [default: compute, or the faster one that `surfel devices --measure` found]
    #[arg(long, value_parser = choice::<Rasterizer>())]
    pub rasterizer: Option<Rasterizer>,
    /// Stores a surfel in 12 instead of 28 bytes, beside its colour; positions move by at most 1/128 of the radius
    #[arg(long)]
    pub quantize: bool,
    /// Time budget of a frame while the camera moves, ms; slower frames become coarser
    #[arg(long, value_name = "MS", value_parser = number::<f64>, default_value_t = 60.0)]
    pub frame_budget: f64,
    /// Loads files again when they change; the camera stays
    #[arg(long)]
    pub watch: bool,
    /// Logs events to standard output as JSON lines
    #[arg(long)]
    pub json: bool,
    /// Starts with the method's default settings instead of the saved ones, and saves none
    #[arg(long)]
    pub fresh: bool,
    /// File with the triangles that the points of INPUT were sampled from: the exact surface of the panel's error [default: the triangles of INPUT]
    #[arg(long, value_name = "MESH", requires = "inputs")]
    pub truth: Option<PathBuf>,
    /// The Vulkan device
    #[command(flatten)]
    pub device: DeviceArgs,
    /// Folder for screenshots and saved cameras; it has to exist
    #[arg(long, alias = "shots", value_name = "FOLDER", default_value = ".")]
    pub screenshots: PathBuf,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

impl View {
    /// The given method, if any: points of a fixed size, if a size is given.
    ///
    /// # Errors
    /// [`surfel::Error::Usage`] as of [`RenderSettings::method`].
    pub fn method(&self) -> Result<Option<Method>> {
        self.render_settings.method(self.method, &self.axes)
    }

    /// The settings of a method with the changes of the options.
    pub fn settings(&self, method: &Method) -> Settings {
        self.render_settings.settings(&self.axes, method)
    }
}
