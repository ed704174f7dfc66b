//! Geometry as plain CPU data, independent of Vulkan.

mod bounds;
mod camera;
mod clips;
mod cloud;
mod coarser;
mod colour_map;
mod materials;
pub(crate) mod memory;
mod merge;
pub(crate) mod morton;
mod pose;
mod primitives;
mod quantity;
mod simplify;
pub mod srgb;
mod strips;
mod surfels;
mod texture;
mod thin;
mod valid;
mod weights;

pub use bounds::Bounds;
pub use camera::{Camera, Projection};
pub use clips::{Clip, ClipLine, Clips};
pub use cloud::{Cloud, View};
pub use colour_map::{ColourMap, ColourScale, ValueRange};
pub use materials::{Material, Materials};
pub use pose::{Pose, Span};
pub use primitives::{Model, Parts, Primitives};
pub use quantity::Quantity;
pub use strips::{Lined, ToLines};
pub use surfels::{Colours, Ellipse, Surfels};
pub use texture::{MipMap, Texture};
pub(crate) use valid::is_unit;
pub(crate) use weights::square_axis;
pub use weights::{Corners, Weights, first_axis};
