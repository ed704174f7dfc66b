//! Options of `surfel bench`.

use super::OnDevice;
use crate::cli::values::{one_of, size};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;
use surfel::bench::Suite;

/// Options of `surfel bench`.
#[derive(Args, Debug)]
pub struct Bench {
    /// PLY files with triangles, or built-in scenes: measured at every density that they have
    #[arg(value_name = "INPUT")]
    pub inputs: Vec<OsString>,
    /// The PLY file with the triangles that the points of INPUT are samples of; unless given, those of INPUT itself
    #[arg(long, value_name = "MESH", requires = "inputs")]
    pub truth: Option<PathBuf>,
    /// Numbers of points of INPUT; from 10000 to 1000000, or to all that there are, unless given
    #[arg(long, value_name = "N,…", value_delimiter = ',', requires = "inputs", value_parser = clap::value_parser!(u64).range(1..))]
    pub points: Vec<u64>,
    /// Size of INPUT's pictures, px; 768x768 unless given
    #[arg(long, value_name = "WxH", value_parser = size, requires = "inputs", allow_hyphen_values = true)]
    pub size: Option<[u32; 2]>,
    /// What is measured; quick unless something else, an INPUT or --from, is given
    #[arg(long, value_parser = one_of(Suite::BUILT_IN), value_delimiter = ',', value_name = "SUITE,…")]
    pub suite: Vec<Suite>,
    /// Shows what --json of earlier calls wrote, here or elsewhere, beside what is measured now
    #[arg(long, value_name = "FILE")]
    pub from: Vec<PathBuf>,
    /// Writes a page with plots and pictures, and the plots as SVG, into a folder
    #[arg(long, value_name = "DIR")]
    pub report: Option<PathBuf>,
    /// Writes everything as JSON; `-` for standard output, in place of the table
    #[arg(long, value_name = "FILE")]
    pub json: Option<OsString>,
    /// Writes a line a run as CSV; `-` for standard output, in place of the table
    #[arg(long, value_name = "FILE")]
    pub csv: Option<OsString>,
    /// On which device
    #[command(flatten)]
    pub device: OnDevice,
    /// Traces exact pictures even if they have been before, and does not keep them
    #[arg(long)]
    pub no_cache: bool,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}
