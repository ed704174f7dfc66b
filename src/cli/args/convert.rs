//! Options of `surfel convert` and `surfel info`.

use super::{Colours, DeviceArgs, Points, inputs};
use crate::cli::values::{angle, direction, positive, whole};
use clap::Args;
use glam::DVec3;
use std::ffi::OsString;
use surfel::estimate::Estimate;
use surfel::formats;
use surfel::geometry::ToLines;

/// Options of `surfel convert`.
#[derive(Args, Debug)]
pub struct Convert {
    /// Files or built-in scenes
    #[arg(required = true, value_name = "INPUT", help = inputs("several become one file"))]
    pub inputs: Vec<OsString>,
    /// The file to write
    #[arg(short, long, value_name = "OUT", help = written(""), long_help = written(WRITTEN))]
    pub output: OsString,
    /// Keeps one point per voxel of this side, in the positions' unit, of all inputs together
    #[arg(long, value_name = "SIZE", value_parser = positive::<f64>, allow_hyphen_values = true, conflicts_with_all = ["polygons", "lines"])]
    pub voxel: Option<f64>,
    /// How normals and radii are estimated
    #[command(flatten)]
    pub points: Points,
    /// Converts leaves and branches of meshes to ribbons and tubes
    ///
    /// Other faces stay, and so do branches thicker than RADIUS, in the positions' unit. RADIUS is 1/250 of the extent's diagonal by default.
    #[arg(long, value_name = "RADIUS", num_args = 0..=1, require_equals = true, default_missing_value = "auto", value_parser = thickest)]
    pub lines: Option<ToLines>,
    /// Simplifies lines with an error of at most TOLERANCE, in the positions' unit
    #[arg(long, value_name = "TOLERANCE", value_parser = positive::<f64>, allow_hyphen_values = true)]
    pub simplify_lines: Option<f64>,
    /// Clips discs at creases where normals differ by more than ANGLE degrees
    #[arg(long, value_name = "ANGLE", value_parser = angle::<f32>, allow_hyphen_values = true)]
    pub sharp: Option<f32>,
    /// Captures normalization weights from VIEWS directions, for --normalization surfel [default: 24]
    #[arg(long, value_name = "VIEWS", num_args = 0..=1, require_equals = true, default_missing_value = "24", value_parser = whole::<u32>(1..=10_000))]
    pub weights: Option<u32>,
    /// The device that captures weights
    #[command(flatten)]
    pub device: DeviceArgs,
    /// Writes the points with the normals and radii that the inputs have, and estimates none
    #[arg(long, conflicts_with_all = ["sharp", "weights", "lines", "radius", "elliptical"])]
    pub bare: bool,
    /// What points are coloured by
    #[command(flatten)]
    pub colours: Colours,
    /// Up direction of the written file, and for --color-by height [default: 0,0,1 for LAS, LAZ, E57, PTX, STL and wide flat bare points, 0,-1,0 for depth images and 3D Gaussians but SPZ, otherwise 0,1,0]
    #[arg(long, value_name = "X,Y,Z", value_parser = direction, allow_hyphen_values = true)]
    pub up: Option<DVec3>,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// What each format of written files holds.
const WRITTEN: &str = "\n\nA PLY file holds position, normal and radius; and where there are any, axes of ellipses, two-sidedness, clip lines, \
    normalization weights, tangents, colour, edges, faces and the properties of the inputs. LAS, LAZ and COPC files hold points with all properties \
    of the inputs, and normal, radius, axes and so on as extra bytes; E57 files hold points with normals, colours, intensities, returns and times. \
    A warning names what is left out.";

/// Help of the written file.
fn written(more: &str) -> String {
    format!("The file to write: {}{more}", formats::writable_names())
}

/// Parses the largest radius of a tube, or `auto`.
fn thickest(text: &str) -> Result<ToLines, String> {
    if text == "auto" {
        return Ok(ToLines::default());
    }
    positive(text).map(|radius| ToLines { thickest: Some(radius) })
}

impl Convert {
    /// The options of the estimation.
    pub fn estimate(&self) -> Estimate {
        Estimate { sharp: self.sharp.map(f32::to_radians), bare: self.bare, ..self.points.estimate() }
    }
}

/// Options of `surfel info`.
#[derive(Args, Debug)]
pub struct Info {
    /// Files or built-in scenes
    #[arg(required = true, value_name = "INPUT", help = inputs("described one by one"))]
    pub inputs: Vec<OsString>,
    /// Estimates normals and radii, and prints where they come from; implied by the options of the estimation
    #[arg(long)]
    pub estimate: bool,
    /// How normals and radii are estimated
    #[command(flatten)]
    pub points: Points,
    /// Prints JSON: an object, or of several inputs an array
    #[arg(long)]
    pub json: bool,
}

impl Info {
    /// Whether normals and radii are estimated.
    pub fn estimates(&self) -> bool {
        self.estimate || self.points.polygons || self.points.estimate() != Estimate::default()
    }
}
