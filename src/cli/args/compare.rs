//! Options of `surfel compare`.

use crate::cli::limits::{Limit, above, below};
use crate::cli::values::{opaque, positive};
use clap::Args;
use std::ffi::OsString;
#[cfg(feature = "bench")]
use std::path::PathBuf;
use surfel::formats::image::READ;
use surfel::verify::metrics::flip::PIXELS_PER_DEGREE;

/// Options of `surfel compare`.
#[derive(Args, Debug)]
pub struct Compare {
    /// The picture
    #[arg(value_name = "A", help = format!("The picture: a {READ} file; PNG and JPEG are sRGB, EXR is linear light"))]
    pub picture: OsString,
    /// The ground truth
    #[arg(value_name = "B", help = format!("The ground truth: a {READ} file of the same size"))]
    pub truth: OsString,
    /// Compares numbered frames, and measures flicker and popping along them: A and B are patterns such as a/%04d.exr
    #[arg(long, conflicts_with = "map")]
    pub frames: bool,
    /// Exits with code 4 if METRIC is above VALUE, for example flip=0.05; may be repeated. For metrics of which less is better
    #[arg(long, value_name = "METRIC=VALUE", value_parser = above)]
    pub fail_above: Vec<Limit>,
    /// Exits with code 4 if METRIC is below VALUE, for example ssim=0.98; may be repeated. For metrics of which more is better
    #[arg(long, value_name = "METRIC=VALUE", value_parser = below)]
    pub fail_below: Vec<Limit>,
    /// Writes FLIP's error map: from black for no difference through red to pale yellow for the largest
    #[arg(long, value_name = "OUT.png")]
    pub map: Option<OsString>,
    /// Writes the metrics as JSON; `-` for standard output, instead of the table
    #[arg(long, value_name = "FILE")]
    pub json: Option<OsString>,
    /// Writes a page with plots along the camera path and the frames around the largest pop; needs --frames
    #[cfg(feature = "bench")]
    #[arg(long, value_name = "FILE.html", requires = "frames")]
    pub report: Option<PathBuf>,
    /// Background of both pictures: sRGB codes from 0 to 255, or a CSS colour
    #[arg(long, value_name = "R,G,B", default_value = "0,0,0", value_parser = opaque, allow_hyphen_values = true)]
    pub background: [f32; 3],
    /// FLIP's resolution, px per degree of visual angle
    #[arg(long, value_name = "N", default_value_t = PIXELS_PER_DEGREE, value_parser = positive::<f32>, allow_hyphen_values = true)]
    pub pixels_per_degree: f32,
    /// Size of the object, in the positions' unit; depth errors are relative to it
    #[arg(long, value_name = "LENGTH", default_value_t = 1.0, value_parser = positive::<f64>, allow_hyphen_values = true)]
    pub object_size: f64,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}
