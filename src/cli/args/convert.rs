//! Options of `surfel convert` and `surfel info`.

use super::{Colours, OnDevice, Points};
use crate::cli::values::{direction, edge, positive};
use clap::Args;
use glam::DVec3;
use std::ffi::OsString;
use surfel::estimate::Estimate;
use surfel::geometry::ToLines;

/// Options of `surfel convert`.
#[derive(Args, Debug)]
pub struct Convert {
    /// PLY files, or built-in scenes such as scene:bumpy-sphere; several become one file
    #[arg(required = true, value_name = "INPUT")]
    pub inputs: Vec<OsString>,
    /// The file: binary PLY with position, normal and radius, and where there are any, axes of ellipses, two-sidedness, clip lines,
    /// normalization weights, tangents, colour, edges and faces
    #[arg(short, long, value_name = "OUT.ply")]
    pub output: OsString,
    /// Keeps one point for every cube of this side, in the positions' unit, of all inputs together
    #[arg(long, value_name = "SIZE", value_parser = positive::<f64>, allow_hyphen_values = true, conflicts_with_all = ["polygons", "lines"])]
    pub voxel: Option<f64>,
    /// How normals and radii are estimated
    #[command(flatten)]
    pub points: Points,
    /// Makes leaves and branches of meshes ribbons and tubes, and keeps the other faces; branches that are thicker than RADIUS, in the
    /// positions' unit, stay; 1/250 of the extent's diagonal unless given
    #[arg(long, value_name = "RADIUS", num_args = 0..=1, default_missing_value = "auto", value_parser = thickest)]
    pub lines: Option<ToLines>,
    /// Drops vertices of lines without which these are off by at most TOLERANCE, in the positions' unit
    #[arg(long, value_name = "TOLERANCE", value_parser = positive::<f64>, allow_hyphen_values = true)]
    pub simplify_lines: Option<f64>,
    /// Ends discs at creases where normals turn by more than ANGLE degrees
    #[arg(long, value_name = "ANGLE", value_parser = edge, allow_hyphen_values = true)]
    pub sharp: Option<f32>,
    /// Captures normalization weights, for object-ewa with --normalization surfel, from VIEWS directions; 24 unless given
    #[arg(long, value_name = "VIEWS", num_args = 0..=1, default_missing_value = "24", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub weights: Option<u32>,
    /// Where weights are captured
    #[command(flatten)]
    pub device: OnDevice,
    /// What points are coloured by
    #[command(flatten)]
    pub colours: Colours,
    /// What is up, for --color-by height
    #[arg(long, value_name = "X,Y,Z", default_value = "0,1,0", value_parser = direction, allow_hyphen_values = true)]
    pub up: DVec3,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// The largest radius of a tube, or `auto`.
fn thickest(text: &str) -> Result<ToLines, String> {
    match text {
        "auto" => Ok(ToLines::default()),
        _ => positive(text).map(|radius| ToLines { thickest: Some(radius) }),
    }
}

impl Convert {
    /// What the library is asked for.
    pub fn estimate(&self) -> Estimate {
        Estimate { sharp: self.sharp.map(f32::to_radians), ..self.points.estimate() }
    }
}

/// Options of `surfel info`.
#[derive(Args, Debug)]
pub struct Info {
    /// A PLY file, or a built-in scene such as scene:bumpy-sphere
    pub input: OsString,
    /// How normals and radii are estimated
    #[command(flatten)]
    pub points: Points,
    /// Prints JSON
    #[arg(long)]
    pub json: bool,
}
