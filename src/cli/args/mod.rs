//! What the program can be asked.

#[cfg(feature = "bench")]
mod bench;
#[cfg(feature = "metrics")]
mod compare;
mod convert;
mod points;
#[cfg(feature = "truth")]
mod truth;
#[cfg(feature = "viewer")]
mod view;

#[cfg(feature = "bench")]
pub use bench::Bench;
#[cfg(feature = "metrics")]
pub use compare::Compare;
pub use convert::{Convert, Info};
pub use points::{Colours, Points};
#[cfg(feature = "truth")]
pub use truth::Truth;
#[cfg(feature = "viewer")]
pub use view::View;

use super::values::{Background, Layer, background, choice, kernel, method, size, vector};
use clap::{Args, Parser, Subcommand};
use clap_complete::Shell;
use glam::DVec3;
use std::ffi::OsString;
use std::path::PathBuf;
use surfel::settings::methods::Method;
use surfel::settings::splatting::{Filter, Footprint, Kernel, Normalization, Shade, Splatting, Visibility};
use surfel::settings::{Alpha, Choice, Cull, Shading, Widen};
use surfel::{Outputs, Rasterizer, Settings};

/// Renders point-sampled surfaces with Vulkan.
#[derive(Debug, Parser)]
#[command(name = "surfel", version)]
pub struct Surfel {
    /// What to do.
    #[command(subcommand)]
    pub command: Command,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Renders points to a picture
    Render(Box<Render>),
    /// Opens a window to look at points and to move around them
    #[cfg(feature = "viewer")]
    View(Box<View>),
    /// Says what is in a file or scene, and what is estimated of it
    Info(Info),
    /// Makes surfels of points once and writes them to a PLY file
    Convert(Box<Convert>),
    /// Compares picture A with the truth B: colours, silhouette, normals, depths
    #[cfg(feature = "metrics")]
    Compare(Box<Compare>),
    /// Traces the exact picture of a built-in scene or a mesh, without Vulkan
    #[cfg(feature = "truth")]
    Truth(Box<Truth>),
    /// Measures speed against error, and makes a page of it
    #[cfg(feature = "bench")]
    Bench(Box<Bench>),
    /// Lists the Vulkan devices; * marks the one that is used unless --device names another
    Devices(Listing),
    /// Lists the methods: paper, choices along the axes, passes, targets
    Methods(Methods),
    /// Lists the built-in scenes with their parameters
    Scenes(Listing),
    /// Prints completions for a shell, to be put where that looks for them
    Completions(Completions),
    /// Writes the manual's pages, surfel.1 and one for each command, to a folder
    Man(Man),
}

/// Options of the commands that list what there is.
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
    /// Prints what frames of different scenes need: a table in Markdown
    #[arg(long, conflicts_with = "json")]
    pub needs: bool,
}

/// Options of `surfel completions`.
#[derive(Args, Debug)]
pub struct Completions {
    /// For which shell
    pub shell: Shell,
}

/// Options of `surfel man`.
#[derive(Args, Debug)]
pub struct Man {
    /// The folder, which exists
    pub folder: PathBuf,
}

/// Options of `surfel render`.
#[derive(Args, Debug)]
pub struct Render {
    /// PLY files, or built-in scenes such as scene:bumpy-sphere; several become one scene
    #[arg(required = true, value_name = "INPUT")]
    pub inputs: Vec<OsString>,
    /// The picture: .png (sRGB, or `-` for standard output) or .exr (linear light)
    #[arg(short, long, value_name = "OUT")]
    pub output: OsString,
    /// Renders N pictures all around, about the up axis through the middle of the scene: OUT has a place for their numbers, as frames/%04d.png
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=100_000))]
    pub turntable: Option<u32>,
    /// How it is rendered; perspective-ewa unless given, pull-push where there are lines or triangles; `surfel methods` tells more
    #[arg(long, value_parser = method())]
    pub method: Option<Method>,
    /// What is changed of the method
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
    /// Draws a bar with the colours of --color-by and their values into the PNG
    #[arg(long, alias = "colour-bar", requires = "color_by")]
    pub color_bar: bool,
    /// What an EXR holds beside the picture
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LAYER,…")]
    pub layers: Vec<Layer>,
    /// Where the camera stands
    #[command(flatten, next_help_heading = "Camera")]
    pub camera: Camera,
    /// How surfels become a picture
    #[command(flatten, next_help_heading = "Picture")]
    pub render_settings: RenderSettings,
    /// Where it is rendered
    #[command(flatten, next_help_heading = "Device")]
    pub place: Place,
    /// Writes a report: device, settings, counts, times; `-` for standard output
    #[arg(long, value_name = "FILE")]
    pub json: Option<OsString>,
    /// Prints how long each pass took
    #[arg(long)]
    pub times: bool,
    /// Renders N times; the first frame warms up and does not count in the times unless it is the only one
    #[arg(long, value_name = "N", default_value_t = 1, value_parser = clap::value_parser!(u32).range(1..))]
    pub frames: u32,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

impl Render {
    /// The images beside the picture that this asks for.
    pub fn outputs(&self) -> Outputs {
        outputs(&self.layers)
    }
}

/// The images that these layers are.
fn outputs(layers: &[Layer]) -> Outputs {
    let asked = |layer| layers.contains(&layer);
    Outputs { normal: asked(Layer::Normal), depth: asked(Layer::Depth), id: asked(Layer::Id) }
}

/// The camera; the whole scene is framed unless it is given.
#[derive(Args, Clone, Debug)]
pub struct Camera {
    /// The eye, in the positions' unit
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub eye: Option<DVec3>,
    /// The point that it looks at; the middle of the scene unless given
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub target: Option<DVec3>,
    /// The direction that is up in the picture; 0,1,0 unless given
    #[arg(long, value_name = "X,Y,Z", value_parser = vector, allow_hyphen_values = true)]
    pub up: Option<DVec3>,
    /// Vertical angle of view; 45 unless given
    #[arg(long, value_name = "DEG", allow_hyphen_values = true)]
    pub fov: Option<f64>,
    /// Makes rays parallel: height of the picture, in the positions' unit
    #[arg(long, value_name = "HEIGHT", conflicts_with = "fov", allow_hyphen_values = true)]
    pub parallel: Option<f64>,
    /// The camera from a file: {"eye":[0,0,3],"target":[0,0,0],"up":[0,1,0],"fov_y_deg":45}, or "height":2 for parallel rays
    #[arg(long = "camera", value_name = "FILE.json", conflicts_with_all = ["eye", "target", "up", "fov", "parallel"])]
    pub file: Option<PathBuf>,
}

/// How surfels become a picture.
#[derive(Args, Debug)]
pub struct RenderSettings {
    /// What the picture shows
    #[arg(long, value_parser = choice::<Shading>(), default_value = Shading::Lit.name())]
    pub shading: Shading,
    /// What α says of a pixel
    #[arg(long, value_parser = choice::<Alpha>(), default_value = Alpha::Mask.name())]
    pub alpha: Alpha,
    /// Colour where nothing is: transparent, sRGB codes from 0 to 255, or as CSS has it: #fff, white
    #[arg(long, value_name = "R,G,B|COLOR|transparent", default_value = "transparent", value_parser = background, allow_hyphen_values = true)]
    pub background: Background,
    /// Variance of the anti-aliasing filter, px²; the method's unless given, 1 of most
    #[arg(long, value_name = "VARIANCE_PX2", allow_hyphen_values = true)]
    pub lowpass: Option<f32>,
    /// What the anti-aliasing filter widens; the method's unless given
    #[arg(long, value_parser = choice::<Widen>())]
    pub widen: Option<Widen>,
    /// Where a splat's kernel ends, in standard deviations; the method's unless given, 2.5 of perspective-ewa
    #[arg(long, value_name = "F", allow_hyphen_values = true)]
    pub cutoff: Option<f32>,
    /// How far behind the nearest splat others still blend with it, in radii
    #[arg(long, value_name = "RADII", default_value_t = Settings::default().epsilon, allow_hyphen_values = true)]
    pub epsilon: f32,
    /// Which surfels are left out for the side that they show; the method's unless given
    #[arg(long, value_parser = choice::<Cull>())]
    pub cull: Option<Cull>,
}

/// What is changed of a method: see `surfel methods`.
#[derive(Args, Debug, Clone, Copy)]
pub struct Axes {
    /// The image of a surfel's disc
    #[arg(long, value_parser = choice::<Footprint>())]
    pub footprint: Option<Footprint>,
    /// How a splat's weight falls off: gaussian, or confetti:A,N
    #[arg(long, value_parser = kernel)]
    pub kernel: Option<Kernel>,
    /// Where the anti-aliasing filter is applied
    #[arg(long, value_parser = choice::<Filter>())]
    pub filter: Option<Filter>,
    /// Which splats a pixel sees
    #[arg(long, value_parser = choice::<Visibility>())]
    pub visibility: Option<Visibility>,
    /// What makes weights add up to 1
    #[arg(long, value_parser = choice::<Normalization>())]
    pub normalization: Option<Normalization>,
    /// What is lit
    #[arg(long, value_parser = choice::<Shade>())]
    pub shade: Option<Shade>,
}

impl Axes {
    /// `splatting` with what is given here.
    fn over(&self, splatting: Splatting) -> Splatting {
        let visibility = self.visibility.unwrap_or(splatting.visibility);
        // One splat alone has nothing to normalize.
        let alone = (visibility == Visibility::Nearest).then_some(Normalization::None);
        Splatting {
            footprint: self.footprint.unwrap_or(splatting.footprint),
            kernel: self.kernel.unwrap_or(splatting.kernel),
            filter: self.filter.unwrap_or(splatting.filter),
            visibility,
            normalization: self.normalization.or(alone).unwrap_or(splatting.normalization),
            shade: self.shade.unwrap_or(splatting.shade),
        }
    }
}

impl Render {
    /// The settings that this asks for of a method.
    pub fn settings(&self, method: &Method) -> Settings {
        self.render_settings.settings(&self.axes, method)
    }
}

impl RenderSettings {
    /// The settings that this asks for of a method, of which `axes` are changed.
    fn settings(&self, axes: &Axes, method: &Method) -> Settings {
        let preset = method.settings();
        Settings {
            splatting: axes.over(preset.splatting),
            pull_push: preset.pull_push,
            cutoff: self.cutoff.unwrap_or(preset.cutoff),
            lowpass: self.lowpass.unwrap_or(preset.lowpass),
            widen: self.widen.unwrap_or(preset.widen),
            epsilon: self.epsilon,
            cull: self.cull.unwrap_or(preset.cull),
            alpha: self.alpha,
            shading: self.shading,
            background: self.background.linear(),
            lighting: preset.lighting,
        }
    }
}

/// Where it is rendered.
#[derive(Args, Debug)]
pub struct Place {
    /// Renders with the float64 reference on the CPU, without Vulkan
    #[arg(long, conflicts_with_all = ["half", "device", "validate", "device_limits"])]
    pub reference: bool,
    /// What visits the pixels: the device's own rasterizer, or compute shaders; what is faster on the device unless given
    #[arg(long, value_parser = choice::<Rasterizer>(), conflicts_with = "reference")]
    pub rasterizer: Option<Rasterizer>,
    /// Keeps sums in 16-bit floats, or the samples of pull-push in 24 bytes of 48: half the memory, coarser
    #[arg(long)]
    pub half: bool,
    /// On which device
    #[command(flatten)]
    pub device: OnDevice,
}

/// A Vulkan device, and how it is opened.
#[derive(Args, Debug)]
pub struct OnDevice {
    /// The Vulkan device, by its index or a part of its name, as `surfel devices` lists it
    #[arg(long, value_name = "INDEX|NAME")]
    pub device: Option<String>,
    /// Runs under the Vulkan validation layers; any message of theirs is an error
    #[arg(long)]
    pub validate: bool,
    /// Restricts the device to what a JSON file allows, to test the fallbacks: {"max_image_side":4096}
    #[arg(long, value_name = "FILE")]
    pub device_limits: Option<PathBuf>,
}
