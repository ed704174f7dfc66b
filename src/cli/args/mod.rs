//! Arguments of the program and its commands.

#[cfg(feature = "bench")]
mod bench;
#[cfg(feature = "metrics")]
mod compare;
mod convert;
mod points;
mod render_settings;
#[cfg(test)]
mod tests;
#[cfg(feature = "truth")]
mod truth;
#[cfg(feature = "viewer")]
mod view;
#[cfg(feature = "bench")]
mod with;

#[cfg(feature = "bench")]
pub use bench::Bench;
#[cfg(feature = "metrics")]
pub use compare::Compare;
pub use convert::{Convert, Info};
pub use points::{Colours, Points};
pub use render_settings::RenderSettings;
#[cfg(feature = "truth")]
pub use truth::Truth;
#[cfg(feature = "viewer")]
pub use view::View;
#[cfg(feature = "bench")]
pub use with::With;

use super::values::{Layer, angle, choice, direction, kernel, method, positive, size, vector, whole};
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use glam::DVec3;
use std::ffi::OsString;
use std::path::PathBuf;
use surfel::formats;
use surfel::settings::methods::Method;
use surfel::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use surfel::{Outputs, Rasterizer, Result, Settings};

/// Renders point-sampled surfaces with Vulkan.
#[derive(Debug, Parser)]
#[command(name = "surfel", version)]
pub struct Surfel {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
}

/// A command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Renders points to a picture
    Render(Box<Render>),
    /// Opens a window that shows points interactively
    #[cfg(feature = "viewer")]
    View(Box<View>),
    /// Prints the contents of files and scenes, and how many normals and radii have to be estimated
    Info(Box<Info>),
    /// Estimates surfels from points, and writes them, or the points alone, to a file
    Convert(Box<Convert>),
    /// Compares picture A with the ground truth B: colours, silhouette, normals, depths
    #[cfg(feature = "metrics")]
    Compare(Box<Compare>),
    /// Ray-traces the exact picture of a built-in scene or a mesh, without Vulkan
    #[cfg(feature = "truth")]
    Truth(Box<Truth>),
    /// Measures speed and error, and writes a report
    #[cfg(feature = "bench")]
    Bench(Box<Bench>),
    /// Lists the Vulkan devices; * marks the default
    Devices(Devices),
    /// Lists the methods: paper, axes, passes, render targets
    Methods(Methods),
    /// Lists the built-in scenes with their parameters
    Scenes(Listing),
    /// Prints the completion script of a shell
    Completions(Completions),
    /// Writes the man pages, surfel.1 and one for each command, to a folder
    Man(Man),
}

/// Help of inputs, of which several may be given.
fn inputs(several: &str) -> String {
    format!("{} files, or built-in scenes such as scene:bumpy-sphere; {several}", formats::names())
}

/// Options of `surfel devices`.
#[derive(Args, Debug)]
pub struct Devices {
    /// Prints JSON
    #[arg(long)]
    pub json: bool,
    /// Measures which rasterizer is faster on the device; later commands prefer it
    #[arg(long)]
    pub measure: bool,
    /// The device to measure, by its index or part of its name
    #[arg(long, value_name = "INDEX|NAME", requires = "measure")]
    pub device: Option<String>,
}

/// Options of the commands that print a list.
#[derive(Args, Debug)]
pub struct Listing {
    /// Prints JSON
    #[arg(long)]
    pub json: bool,
}

/// Options of `surfel methods`.
#[derive(Args, Debug)]
pub struct Methods {
    /// Prints JSON
    #[arg(long)]
    pub json: bool,
    /// Prints a Markdown table of the streams, passes and targets of different scenes
    #[arg(long, conflicts_with = "json")]
    pub needs: bool,
}

/// Options of `surfel completions`.
#[derive(Args, Debug)]
pub struct Completions {
    /// The shell
    pub shell: Shell,
}

/// Options of `surfel man`.
#[derive(Args, Debug)]
pub struct Man {
    /// The folder; the command creates it if its parent exists
    pub folder: PathBuf,
}

/// Options of `surfel render`.
#[derive(Args, Debug)]
pub struct Render {
    /// Files or built-in scenes
    #[arg(required = true, value_name = "INPUT", help = inputs("several become one scene"))]
    pub inputs: Vec<OsString>,
    /// The picture: .png (sRGB, or `-` for standard output) or .exr (linear light)
    #[arg(short, long, value_name = "OUT")]
    pub output: OsString,
    /// Renders N pictures on a full turn about the scene's up axis; OUT is a pattern such as frames/%04d.png, whose folder is created if its parent exists
    #[arg(long, value_name = "N", value_parser = whole::<u32>(1..=100_000))]
    pub turntable: Option<u32>,
    /// The method [default: perspective-ewa; pull-push for lines or triangles]; see `surfel methods`
    #[arg(long, value_parser = method())]
    pub method: Option<Method>,
    /// Changes of the method
    #[command(flatten, next_help_heading = "Method, changed")]
    pub axes: Axes,
    /// Size of the picture, px
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = size, allow_hyphen_values = true)]
    pub size: [u32; 2],
    /// How normals and radii are estimated
    #[command(flatten, next_help_heading = "Points")]
    pub points: Points,
    /// What points are coloured by
    #[command(flatten, next_help_heading = "Colours")]
    pub colours: Colours,
    /// Draws a bar with the colours and their values into the PNG, where colours stand for values
    #[arg(
        long,
        alias = "colour-bar",
        value_enum,
        value_name = "WHEN",
        num_args = 0..=1,
        require_equals = true,
        default_value = "auto",
        default_missing_value = "on"
    )]
    pub color_bar: ColorBar,
    /// Additional layers of an EXR file
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LAYER,…")]
    pub layers: Vec<Layer>,
    /// The camera
    #[command(flatten, next_help_heading = "Camera")]
    pub camera: Camera,
    /// Writes the camera of the picture, the first one of a turntable, to a file for --camera; `-` for standard output
    #[arg(long, value_name = "FILE.json", help_heading = "Camera")]
    pub save_camera: Option<OsString>,
    /// The render settings
    #[command(flatten, next_help_heading = "Picture")]
    pub render_settings: RenderSettings,
    /// The device or the reference that renders
    #[command(flatten, next_help_heading = "Device")]
    pub backend: Backend,
    /// Writes a report: device, settings, counts, times; `-` for standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<OsString>,
    /// Prints the time of each pass; `=split` also of passes that do several stages together, stage by stage, and their ratio
    #[arg(long, value_enum, value_name = "PASSES", num_args = 0..=1, require_equals = true, default_missing_value = "passes")]
    pub times: Option<PassTimes>,
    /// Renders N frames; the times exclude the first one unless it is the only one
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = whole::<u32>(1..=u32::MAX.into()))]
    pub frames: u32,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// When a colour bar is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum ColorBar {
    /// Where colours stand for values, in a PNG that has room for it
    Auto,
    /// Always: without values, or room for it, the picture is an error
    On,
    /// Never
    Off,
}

/// Which passes are timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum PassTimes {
    /// Those of a frame
    Passes,
    /// Beside them visibility, attribute and normalize apart
    Split,
}

impl Render {
    /// The given method, if any: see [`RenderSettings::method`].
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

    /// The additional images.
    pub fn outputs(&self) -> Outputs {
        outputs(&self.layers)
    }
}

/// The images of these layers.
fn outputs(layers: &[Layer]) -> Outputs {
    let has = |layer| layers.contains(&layer);
    Outputs { normal: has(Layer::Normal), depth: has(Layer::Depth), id: has(Layer::Id) }
}

/// The camera; by default it frames the whole scene.
#[derive(Args, Clone, Debug)]
pub struct Camera {
    /// Position of the eye, in the positions' unit
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub eye: Option<DVec3>,
    /// The point that the camera looks at [default: the centre of the scene]
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub target: Option<DVec3>,
    /// Up direction of the picture [default: 0,0,1 for LAS, LAZ, E57, PTX, STL and wide flat bare points, 0,-1,0 for depth images and 3D Gaussians but SPZ, otherwise 0,1,0]
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub up: Option<DVec3>,
    /// Vertical angle of view, degrees [default: 45]
    #[arg(long, value_name = "DEG", value_parser = angle::<f64>, allow_hyphen_values = true)]
    pub fov: Option<f64>,
    /// Parallel projection: height of the picture, in the positions' unit
    #[arg(long, value_name = "HEIGHT", value_parser = positive::<f64>, conflicts_with = "fov", allow_hyphen_values = true)]
    pub parallel: Option<f64>,
    /// Reads the camera from a JSON file
    ///
    /// For example {"eye":[0,0,3],"target":[0,0,0],"up":[0,1,0],"fov_y_deg":45}; for a parallel projection "height":2 instead of "fov_y_deg".
    #[arg(long = "camera", value_name = "FILE.json", conflicts_with_all = ["eye", "target", "up", "fov", "parallel"])]
    pub file: Option<PathBuf>,
}

/// Changes of a method; see `surfel methods`.
#[derive(Args, Debug, Clone, Copy)]
pub struct Axes {
    /// Projection of a surfel's disc
    #[arg(long, value_parser = choice::<Footprint>())]
    pub footprint: Option<Footprint>,
    /// Falloff of a splat's weight: gaussian, or confetti:A,N
    #[arg(long, value_parser = kernel)]
    pub kernel: Option<Kernel>,
    /// Where the anti-aliasing filter is applied
    #[arg(long, value_parser = choice::<Filter>())]
    pub filter: Option<Filter>,
    /// Which splats of a pixel are blended
    #[arg(long, value_parser = choice::<Visibility>())]
    pub visibility: Option<Visibility>,
    /// How weights are normalized
    #[arg(long, value_parser = choice::<Normalization>())]
    pub normalization: Option<Normalization>,
    /// Whether pixels or splats are lit
    #[arg(long, value_parser = choice::<Shade>())]
    pub shade: Option<Shade>,
}

impl Axes {
    /// `splatting` with these changes.
    fn apply(&self, splatting: Splatting) -> Splatting {
        let visibility = self.visibility.unwrap_or(splatting.visibility);
        // A single splat is not normalized.
        let single = (visibility == Visibility::Nearest).then_some(Normalization::None);
        Splatting {
            footprint: self.footprint.unwrap_or(splatting.footprint),
            kernel: self.kernel.unwrap_or(splatting.kernel),
            filter: self.filter.unwrap_or(splatting.filter),
            visibility,
            normalization: self.normalization.or(single).unwrap_or(splatting.normalization),
            shade: self.shade.unwrap_or(splatting.shade),
        }
    }
}

/// The device or the reference that renders.
#[derive(Args, Debug)]
pub struct Backend {
    /// Renders with the float64 reference on the CPU, without Vulkan
    #[arg(long, conflicts_with_all = ["half", "device", "validate", "device_limits"])]
    pub reference: bool,
    /// The device's rasterizer, or compute shaders [default: compute, or the faster one that `surfel devices --measure` found]
    #[arg(long, value_parser = choice::<Rasterizer>(), conflicts_with = "reference")]
    pub rasterizer: Option<Rasterizer>,
    /// Stores sums in 16-bit floats, and pull-push samples in 24 instead of 48 bytes: half the memory, less precise
    #[arg(long)]
    pub half: bool,
    /// Stores a surfel in 12 instead of 28 bytes, beside its colour; positions move by at most 1/128 of the radius
    #[arg(long)]
    pub quantize: bool,
    /// The Vulkan device
    #[command(flatten)]
    pub device: DeviceArgs,
}

/// The Vulkan device, and how it is opened.
#[derive(Args, Debug)]
pub struct DeviceArgs {
    /// The Vulkan device, by its index or part of its name; see `surfel devices`
    #[arg(long, value_name = "INDEX|NAME")]
    pub device: Option<String>,
    /// Enables the Vulkan validation layers; any message is an error
    #[arg(long)]
    pub validate: bool,
    /// Limits the device as a JSON file says, to test fallbacks: {"max_image_side":4096}
    #[arg(long, value_name = "FILE")]
    pub device_limits: Option<PathBuf>,
}
