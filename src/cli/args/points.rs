//! Options of every command that reads points: estimation of missing attributes, and colours.

use crate::cli::values::{ColourBy, bounds, choice, class, colour_by, positive, scanner, whole};
use clap::Args;
use glam::DVec3;
use std::num::NonZeroU64;
use std::path::PathBuf;
use std::sync::Arc;
use surfel::Result;
use surfel::estimate::{Estimate, MeshSampling, NormalSource, Scanner};
use surfel::formats::{Filter, Returns, image};
use surfel::geometry::{ColourMap, MipMap};
use surfel::load::{Colouring, Uncoloured};
use surfel::settings::Choice;

/// How normals and radii are estimated.
#[derive(Args, Debug)]
pub struct Points {
    /// Keeps at most N points of each file, evenly spread; of files with more, radii are estimated, and lines and faces left out; of COPC only the coarse levels are read [default: all]
    #[arg(long, value_name = "N", value_parser = whole::<u64>(1..=u64::MAX), allow_hyphen_values = true)]
    pub points: Option<u64>,
    /// Reads points in this box alone, in the files' coordinates: XMIN,YMIN,ZMIN,XMAX,YMAX,ZMAX, or XMIN,YMIN,XMAX,YMAX for any z
    ///
    /// Of COPC, nodes of its octree outside of the box are not read.
    #[arg(long, value_name = "MIN,MAX", value_parser = bounds, allow_hyphen_values = true)]
    pub bounds: Option<[DVec3; 2]>,
    /// Reads points of these classes alone, by numbers or names, as 2,6 or ground,building
    #[arg(long, value_name = "CLASS,…", value_delimiter = ',', value_parser = class)]
    pub class: Option<Vec<u8>>,
    /// Reads these returns of a lidar's pulses alone
    #[arg(long, value_name = "WHICH", value_parser = choice::<Returns>())]
    pub returns: Option<Returns>,
    /// Reads one point in N alone, from the first of each file on; neither lines nor faces
    #[arg(long, value_name = "N", value_parser = whole::<u64>(1..=u64::MAX), allow_hyphen_values = true)]
    pub every: Option<u64>,
    /// Names of the columns of text files, such as x,y,z,-,intensity, where - ignores a column [default: the file's first line, or by the numbers]
    #[arg(long, value_name = "NAME,…", value_delimiter = ',', allow_hyphen_values = true)]
    pub columns: Option<Vec<String>>,
    /// Radius of every surfel, in the positions' unit [default: the file's, or else estimated]
    #[arg(long, value_name = "R", value_parser = positive::<f32>, allow_hyphen_values = true)]
    pub radius: Option<f32>,
    /// Factor of every radius
    #[arg(long, value_name = "S", default_value_t = 1.0, value_parser = positive::<f32>, allow_hyphen_values = true)]
    pub radius_scale: f32,
    /// Number of nearest points that normals and radii are estimated from, 6 to 64
    #[arg(long, value_name = "K", default_value_t = 16, value_parser = whole::<u8>(6..=64), allow_hyphen_values = true)]
    pub neighbours: u8,
    /// Estimates elliptical discs, longer along directions in which points are sparser; those on the triangles of a mesh stay
    #[arg(long)]
    pub elliptical: bool,
    /// Gives points on no surface, as in vegetation, an estimated normal, too; otherwise their discs face the eye
    #[arg(long)]
    pub no_billboards: bool,
    /// Position of the scanner, in the files' coordinates: auto, file or X,Y,Z
    ///
    /// auto: where the file says; otherwise 0,0,0 if the directions of the points from there are a grid, as of lidars. file: where the file says, or unknown.
    #[arg(long, value_name = "WHERE", value_parser = scanner, default_value = "auto", allow_hyphen_values = true)]
    pub scanner: Scanner,
    /// Normals of points
    #[arg(
        long,
        value_name = "WHICH",
        value_parser = choice::<NormalSource>(),
        default_value = NormalSource::Auto.name(),
    )]
    pub normals: NormalSource,
    /// Where the surfels of a mesh are
    #[arg(
        long,
        value_name = "WHERE",
        value_parser = choice::<MeshSampling>(),
        default_value = MeshSampling::Auto.name(),
    )]
    pub mesh_sampling: MeshSampling,
    /// Drops points whose mean distance to their neighbours exceeds the average by SIGMA standard deviations
    #[arg(long, value_name = "SIGMA", value_parser = positive::<f32>, allow_hyphen_values = true)]
    pub drop_outliers: Option<f32>,
    /// Draws faces as triangles instead of their vertices as points; implied for files with lines
    #[arg(long)]
    pub polygons: bool,
    /// Radius of ribbons and tubes without one, in the positions' unit
    #[arg(long, value_name = "R", value_parser = positive::<f32>, allow_hyphen_values = true)]
    pub line_radius: Option<f32>,
}

impl Points {
    /// Which points are read.
    pub fn filter(&self) -> Filter {
        let every = self.every.and_then(NonZeroU64::new);
        Filter { bounds: self.bounds, classes: self.class.clone(), returns: self.returns, every }
    }

    /// The options of the estimation.
    pub fn estimate(&self) -> Estimate {
        Estimate {
            neighbours: self.neighbours.into(),
            radius: self.radius,
            radius_scale: self.radius_scale,
            elliptical: self.elliptical,
            outlines: true,
            billboards: !self.no_billboards,
            scanner: self.scanner,
            normals: self.normals,
            mesh_sampling: self.mesh_sampling,
            outliers: self.drop_outliers,
            sharp: None,
            line_radius: self.line_radius,
            bare: false,
        }
    }
}

/// Name of the files' own colours.
const OWN: &str = "file";

/// What points are coloured by, instead of by their own colours.
#[derive(Args, Debug)]
pub struct Colours {
    /// Colours by x, y, z, height, radius or normal, by a property of the files such as intensity, or by the file's own colours [default: file,
    /// or for bare points without colours intensity, or height where z is up]
    ///
    /// The range is MIN,MAX; by default from the 1st to the 99th percentile.
    #[arg(long, alias = "colour-by", value_name = "NAME[:MIN,MAX]", value_parser = colour_by)]
    pub color_by: Option<ColourBy>,
    /// Colour map of --color-by
    #[arg(
        long,
        alias = "colour-map",
        value_name = "MAP",
        value_parser = choice::<ColourMap>(),
        default_value = ColourMap::Viridis.name(),
        requires = "color_by"
    )]
    pub color_map: ColourMap,
    /// Texture of the files' texture coordinates
    #[arg(long, value_name = "FILE", conflicts_with = "color_by", help = format!("Texture of the files' texture coordinates, instead of the one that they name: {}", image::READ))]
    pub texture: Option<PathBuf>,
}

impl Colours {
    /// The number or attribute to colour by, unless it is the files' own colours.
    pub fn by(&self) -> Option<&ColourBy> {
        self.color_by.as_ref().filter(|by| by.name != OWN)
    }

    /// What happens to points without colours.
    pub fn uncoloured(&self, then: Uncoloured) -> Uncoloured {
        if self.color_by.is_some() { Uncoloured::Plain } else { then }
    }

    /// What points are coloured by; `None` for their own colours.
    ///
    /// # Errors
    /// [`surfel::Error::Usage`] if a range is given for normals, which have no values.
    pub fn colouring(&self) -> Result<Option<Colouring>> {
        self.by().map(|by| Colouring::new(&by.name, by.range, self.color_map)).transpose()
    }

    /// Reads the texture, if one is given.
    pub fn texture(&self) -> Result<Option<Arc<MipMap>>> {
        let read = |path: &PathBuf| MipMap::new(&image::read(path)?).map(Arc::new);
        self.texture.as_ref().map(read).transpose()
    }
}
