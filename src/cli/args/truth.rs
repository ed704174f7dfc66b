//! Options of `surfel truth`.

use super::{Camera, Layer, choice, size};
use crate::cli::values::{Background, Filter, background, positive, whole};
use clap::Args;
use std::ffi::OsString;
use surfel::formats;
use surfel::settings::{Choice, Shading};
use surfel::verify::truth;
use surfel::{Outputs, Settings};

/// Options of `surfel truth`.
#[derive(Args, Debug)]
pub struct Truth {
    /// A built-in scene or a triangle mesh
    #[arg(help = format!("A built-in scene such as scene:bumpy-sphere, or a {} file with triangles", formats::mesh_names()))]
    pub input: OsString,
    /// The picture: .png (sRGB, or `-` for standard output) or .exr (linear light)
    #[arg(short, long, value_name = "OUT")]
    pub output: OsString,
    /// Size of the picture, px
    #[arg(long, value_name = "WxH", default_value = "1024x1024", value_parser = size, allow_hyphen_values = true)]
    pub size: [u32; 2],
    /// Reconstruction filter of the pixels
    #[arg(long, value_enum, default_value = "gaussian")]
    pub filter: Filter,
    /// Variance of the Gaussian, px²
    #[arg(long, value_name = "VARIANCE_PX2", default_value_t = 1.0, value_parser = positive::<f64>, allow_hyphen_values = true)]
    pub variance: f64,
    /// Target of every pixel's standard error, in linear light
    #[arg(long, value_name = "E", default_value_t = truth::Options::default().error, value_parser = positive::<f64>, allow_hyphen_values = true)]
    pub error: f64,
    /// Maximum number of rays per pixel
    #[arg(long, value_name = "N", default_value_t = truth::Options::default().most_samples, value_parser = whole::<u32>(0..=u32::MAX.into()), allow_hyphen_values = true)]
    pub most_samples: u32,
    /// Additional layers of an EXR file
    #[arg(long, value_enum, value_delimiter = ',', value_name = "LAYER,…")]
    pub layers: Vec<Layer>,
    /// The camera
    #[command(flatten)]
    pub camera: Camera,
    /// What the picture shows
    #[arg(long, value_parser = choice::<Shading>(), default_value = Shading::Lit.name())]
    pub shading: Shading,
    /// Background: transparent, sRGB codes from 0 to 255, or a CSS colour such as #fff or white
    #[arg(long, value_name = "R,G,B|COLOR|transparent", default_value = "transparent", value_parser = background, allow_hyphen_values = true)]
    pub background: Background,
    /// Traces the picture without reading or writing the cache
    #[arg(long)]
    pub no_cache: bool,
    /// Prints nothing but warnings and errors
    #[arg(short, long)]
    pub quiet: bool,
}

impl Truth {
    /// The render settings.
    pub fn settings(&self) -> Settings {
        let background = self.background.linear();
        Settings { shading: self.shading, background, ..Default::default() }
    }

    /// The options of the ray tracer.
    pub fn options(&self) -> truth::Options {
        let filter = match self.filter {
            Filter::Gaussian => truth::Filter::Gaussian { variance: self.variance },
            Filter::Box => truth::Filter::Box,
            Filter::Point => truth::Filter::Point,
        };
        truth::Options { filter, error: self.error, most_samples: self.most_samples }
    }

    /// The additional images.
    pub fn outputs(&self) -> Outputs {
        super::outputs(&self.layers)
    }
}
