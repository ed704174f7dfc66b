//! One file a pass, beside the shader of the same name: `new` makes the pipelines, `record` the commands.
//!
//! Visibility, attribute and normalize come in two kinds, one for each [`crate::variant::Rasterizer`].

mod attribute;
mod footprint;
mod normalize;
mod scatter;
mod splats;
mod visibility;

pub use attribute::{ComputeAttribute, DrawAttribute};
pub use footprint::Footprint;
pub use normalize::{ComputeNormalize, DrawNormalize, NormalizeViews};
pub use scatter::{PixelSet, Scatter};
pub use splats::{SplatLayout, Splats};
pub use visibility::{ComputeVisibility, DrawVisibility};
