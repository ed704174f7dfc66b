//! One file a pass, beside the shader of the same name: `new` makes the pipelines, `record` the commands.
//!
//! Visibility, attribute, nearest and normalize come in two kinds, one for each [`crate::variant::Rasterizer`]; so does what project does of
//! points, which are drawn in a file of their own. A third kind draws in subpasses of a host ([`crate::embed::native`]).

mod attribute;
#[cfg(feature = "window")]
mod colour_map;
mod composite;
mod copy;
mod coverage;
mod footprint;
mod nearest;
mod normalize;
mod points;
mod primitives;
mod project;
mod pull;
mod push;
mod pyramid;
#[cfg(feature = "window")]
mod range;
mod resolve;
mod scatter;
mod seed;
mod shade;
mod splats;
mod surface;
mod tiles;
mod visibility;

pub use attribute::{ComputeAttribute, DrawAttribute, SubpassAttribute};
#[cfg(feature = "window")]
pub use colour_map::{ColourMap, ColourMapViews};
pub use composite::{Composite, CompositeKind};
pub use copy::copy;
pub(crate) use coverage::{DrawnCoverage, clear_drawn};
pub use footprint::Footprint;
pub use nearest::{ComputeNearest, DrawNearest, NearestViews};
pub use normalize::{
    ComputeNormalize, DrawNormalize, NormalizeViews, SubpassKind, SubpassNormalize, SubpassViews,
};
pub use points::{DrawPoints, PointViews};
pub use project::{Project, ProjectScene};
pub use pull::Pull;
pub use push::Push;
pub use pyramid::PyramidSets;
#[cfg(feature = "window")]
pub use range::{Range, range_of};
pub use resolve::Resolve;
pub use scatter::{PixelSet, Scatter};
pub use seed::Seed;
pub use shade::Shade;
pub use splats::{SplatLayout, Splats};
pub use surface::SubpassSurface;
pub use tiles::Tiles;
pub use visibility::{ComputeVisibility, DrawVisibility, VisibilityViews};
