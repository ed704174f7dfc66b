//! One file a pass, beside the shader of the same name: `new` makes the pipeline, `record` the commands.

mod attribute;
mod footprint;
mod normalize;
mod splats;
mod visibility;

pub use attribute::Attribute;
pub use footprint::Footprint;
pub use normalize::Normalize;
pub use splats::{SplatLayout, Splats};
pub use visibility::Visibility;
