//! Options of `surfel view`.

use super::{Axes, Camera, Colours, OnDevice, Points, RenderSettings};
use crate::cli::values::{choice, method, size};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;
use surfel::settings::methods::Method;
use surfel::{Rasterizer, Settings};

/// Options of `surfel view`.
#[derive(Args, Debug)]
pub struct View {
    /// PLY files, or built-in scenes such as scene:bumpy-sphere; several become one scene; the window begins empty without any
    #[arg(value_name = "INPUT")]
    pub inputs: Vec<OsString>,
    /// How it is rendered at first; perspective-ewa unless given, pull-push where there are lines or triangles
    #[arg(long, value_parser = method())]
    pub method: Option<Method>,
    /// What is changed of the method
    #[command(flatten)]
    pub axes: Axes,
    /// Size of the window, px; the picture is what the panel leaves of it
    #[arg(long, value_name = "WxH", default_value = "1024x768", value_parser = size, allow_hyphen_values = true)]
    pub size: [u32; 2],
    /// How normals and radii are estimated
    #[command(flatten)]
    pub points: Points,
    /// What points are coloured by
    #[command(flatten)]
    pub colours: Colours,
    /// Where the camera stands at first
    #[command(flatten)]
    pub camera: Camera,
    /// How surfels become a picture
    #[command(flatten)]
    pub render_settings: RenderSettings,
    /// What visits the pixels: the device's own rasterizer, or compute shaders; what is faster on the device unless given
    #[arg(long, value_parser = choice::<Rasterizer>())]
    pub rasterizer: Option<Rasterizer>,
    /// How long frames may take while the camera moves; they are coarser where whole ones take longer
    #[arg(long, value_name = "MS", default_value_t = 60.0)]
    pub budget: f64,
    /// Loads files again when they change; the camera stays
    #[arg(long)]
    pub watch: bool,
    /// Says what happens on standard output, one JSON object a line, for programs that wait for it
    #[arg(long)]
    pub json: bool,
    /// Begins with the method's own settings, rather than with those of the last time, and remembers nothing
    #[arg(long)]
    pub fresh: bool,
    /// On which device
    #[command(flatten)]
    pub device: OnDevice,
    /// Folder for screenshots and saved cameras; the current one unless given
    #[arg(long, alias = "shots", value_name = "FOLDER", default_value = ".")]
    pub screenshots: PathBuf,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

impl View {
    /// The settings that this asks for of a method.
    pub fn settings(&self, method: &Method) -> Settings {
        self.render_settings.settings(&self.axes, method)
    }
}
