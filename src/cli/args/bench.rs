//! Options of `surfel bench`.

use super::{DeviceArgs, With};
use crate::cli::values::{method, one_of, positive, size, whole};
use clap::{Args, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;
use surfel::bench::Suite;
use surfel::settings::methods::Method;
use surfel::verify::truth;

/// Options of `surfel bench`.
#[derive(Args, Debug)]
pub struct Bench {
    /// Files, or built-in scenes: each is measured by every method at several densities
    #[arg(value_name = "INPUT")]
    pub inputs: Vec<OsString>,
    /// File with the triangles that the points of INPUT were sampled from [default: those of INPUT; without any, each method's own float64 reference of all points]
    #[arg(long, value_name = "MESH", requires = "inputs")]
    pub truth: Option<PathBuf>,
    /// Numbers of points of INPUT [default: from 10000 to 1000000, at most all]
    #[arg(long, value_name = "N,…", value_delimiter = ',', requires = "inputs", value_parser = whole::<u64>(1..=u64::MAX))]
    pub points: Vec<u64>,
    /// Methods that render INPUT [default: all but those as published]
    #[arg(long, value_name = "METHOD,…", value_delimiter = ',', requires = "inputs", value_parser = method())]
    pub method: Vec<Method>,
    /// Options of `surfel render`, such as '--lod 2' or '--edges nearest --alpha mask': each method renders INPUT with them as well; may be repeated
    #[arg(long, value_name = "OPTIONS", requires = "inputs", allow_hyphen_values = true)]
    pub with: Vec<With>,
    /// Size of INPUT's pictures, px [default: 768x768; 384x384 without triangles]
    #[arg(long, value_name = "WxH", value_parser = size, requires = "inputs", allow_hyphen_values = true)]
    pub size: Option<[u32; 2]>,
    /// Suites to measure [default: quick, unless INPUT or --from is given]
    #[arg(long, value_parser = one_of(Suite::BUILT_IN), value_delimiter = ',', value_name = "SUITE,…")]
    pub suite: Vec<Suite>,
    /// Filter of the exact pictures that errors are against [default: gaussian]
    #[arg(long, value_enum)]
    pub filter: Option<TruthFilter>,
    /// Folder of scans that quick, the first one by name only, and full measure beside the built-in scenes
    #[arg(long, value_name = "DIR")]
    pub scans: Option<PathBuf>,
    /// Folder with models of the papers, for --suite papers: files such as dragon_vrip.ply, by their names
    #[arg(long, value_name = "DIR", requires = "suite")]
    pub models: Option<PathBuf>,
    /// Time for all measurements, minutes: leaves out runs of the most points and pixels that it does not suffice for [default: no limit]
    #[arg(long, value_name = "N", value_parser = minutes)]
    pub minutes: Option<Duration>,
    /// Adds the results that --json of earlier calls wrote, on this computer or another; of a folder, those of all its JSON files
    #[arg(long, value_name = "PATH")]
    pub from: Vec<PathBuf>,
    /// Writes a page with plots and pictures, and the plots as SVG, to a folder
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Writes all results as JSON; `-` for standard output, instead of the table
    #[arg(long, value_name = "FILE")]
    pub json: Option<OsString>,
    /// Continues the measurement that was interrupted, with its results in the file of --json
    #[arg(long, requires = "json")]
    pub resume: bool,
    /// Writes one line per run as CSV; `-` for standard output, instead of the table
    #[arg(long, value_name = "FILE")]
    pub csv: Option<OsString>,
    /// Prints the JSON schema of --json, and measures nothing
    #[arg(long, exclusive = true)]
    pub schema: bool,
    /// The Vulkan device
    #[command(flatten)]
    pub device: DeviceArgs,
    /// Traces exact pictures without reading or writing the cache
    #[arg(long)]
    pub no_cache: bool,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

/// Filter of exact pictures.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TruthFilter {
    /// A Gaussian with a variance of 1 px²: the filter of EWA splatting, and nearly that of most presets
    Gaussian,
    /// The mean over the pixel's square
    Box,
}

impl From<TruthFilter> for truth::Filter {
    fn from(filter: TruthFilter) -> Self {
        match filter {
            TruthFilter::Gaussian => Self::DEFAULT,
            TruthFilter::Box => Self::Box,
        }
    }
}

/// Most minutes of a time limit: about two years.
const MOST_MINUTES: f64 = 1e6;

/// A time limit in minutes.
fn minutes(text: &str) -> Result<Duration, String> {
    let minutes: f64 = positive(text)?;
    if minutes > MOST_MINUTES {
        return Err(format!("{text} is more than {MOST_MINUTES}"));
    }
    Ok(Duration::from_secs_f64(60.0 * minutes))
}
