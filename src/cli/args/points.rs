//! Options of every command that reads points: how what a file lacks is estimated, and what points are coloured by.

use crate::cli::values::{ColourBy, choice, colour_by, positive};
use clap::Args;
use glam::DVec3;
use std::path::PathBuf;
use std::sync::Arc;
use surfel::Result;
use surfel::estimate::Estimate;
use surfel::formats::image;
use surfel::geometry::{ColourMap, MipMap};
use surfel::load::Colouring;
use surfel::settings::Choice;

/// How normals and radii are estimated.
#[derive(Args, Debug)]
pub struct Points {
    /// Radius of every surfel, in the positions' unit; else the file's, else estimated
    #[arg(long, value_name = "R", value_parser = positive::<f32>, allow_hyphen_values = true)]
    pub radius: Option<f32>,
    /// Factor of every radius
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = positive::<f32>, allow_hyphen_values = true)]
    pub radius_scale: f32,
    /// How many nearest points normals and radii are estimated from, 6 to 64
    #[arg(long, value_name = "K", default_value_t = 16, value_parser = clap::value_parser!(u8).range(6..=64), allow_hyphen_values = true)]
    pub neighbours: u8,
    /// Estimates elliptical discs, longer where points are sparser
    #[arg(long)]
    pub elliptical: bool,
    /// Drops points whose mean distance from their neighbours is more than SIGMA standard deviations above the average
    #[arg(long, value_name = "SIGMA", value_parser = positive::<f32>, allow_hyphen_values = true)]
    pub drop_outliers: Option<f32>,
    /// Draws faces as triangles, rather than their vertices as points; where there are lines, they are anyway
    #[arg(long)]
    pub polygons: bool,
    /// Radius of ribbons and tubes where they have none, in the positions' unit
    #[arg(long, value_name = "R", value_parser = positive::<f32>, allow_hyphen_values = true)]
    pub line_radius: Option<f32>,
}

impl Points {
    /// What the library is asked for.
    pub fn estimate(&self) -> Estimate {
        Estimate {
            neighbours: self.neighbours.into(),
            radius: self.radius,
            radius_scale: self.radius_scale,
            elliptical: self.elliptical,
            outliers: self.drop_outliers,
            sharp: None,
            line_radius: self.line_radius,
        }
    }
}

/// What points are coloured by, instead of by their own colours.
#[derive(Args, Debug)]
pub struct Colours {
    /// Colours by a number: x, y, z, height, radius or normal of the surfels, or a property of the files such as intensity;
    /// from its 1st to its 99th percentile unless MIN,MAX are given
    #[arg(long, alias = "colour-by", value_name = "NAME[:MIN,MAX]", value_parser = colour_by)]
    pub color_by: Option<ColourBy>,
    /// The colours of --color-by
    #[arg(
        long,
        alias = "colour-map",
        value_name = "MAP",
        value_parser = choice::<ColourMap>(),
        default_value = ColourMap::Viridis.name(),
        requires = "color_by"
    )]
    pub color_map: ColourMap,
    /// The picture that the files' texture coordinates are of, rather than the one that they name: PNG, JPEG or EXR
    #[arg(long, value_name = "FILE", conflicts_with = "color_by")]
    pub texture: Option<PathBuf>,
}

impl Colours {
    /// What points are coloured by, if by anything but their own colours; `up` need not be of unit length.
    ///
    /// # Errors
    /// [`surfel::Error::Usage`] if a range is given of what has no values.
    pub fn colouring(&self, up: DVec3) -> Result<Option<Colouring>> {
        let by = self.color_by.as_ref();
        by.map(|by| Colouring::new(&by.name, by.range, self.color_map, up)).transpose()
    }

    /// The texture that is given, if one is.
    pub fn texture(&self) -> Result<Option<Arc<MipMap>>> {
        let read = |path: &PathBuf| MipMap::new(&image::read(path)?).map(Arc::new);
        self.texture.as_ref().map(read).transpose()
    }
}
