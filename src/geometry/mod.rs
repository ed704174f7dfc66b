//! Geometry as plain CPU data, independent of Vulkan.

mod bounds;
mod camera;
mod clips;
mod cloud;
mod colour_map;
mod curvature;
mod discs;
pub(crate) mod eigen;
mod extent;
mod face_textures;
mod join;
mod levels;
mod materials;
pub(crate) mod memory;
mod merge;
pub(crate) mod morton;
mod point_octree;
mod pose;
mod primitives;
mod quantity;
mod quantized;
mod simplify;
pub mod srgb;
mod strips;
mod surfels;
mod texture;
#[cfg(feature = "estimate")]
mod texture_detail;
mod thin;
#[cfg(any(feature = "estimate", feature = "io"))]
mod usual_extent;
mod valid;
mod viewpoints;
mod weights;

pub use bounds::Bounds;
pub use camera::{Camera, Projection};
pub use clips::{Clip, ClipLine, Clips};
pub use cloud::{Cloud, View};
pub use colour_map::{ColourMap, ColourScale, ValueRange};
pub use curvature::{Curvature, tangents};
pub use extent::{Extent, horizontal_axes};
pub use face_textures::{FaceImage, FaceTexture, FaceTextures};
pub use levels::{LevelTable, Levels, MOST_LEVELS, MostDrawn};
pub use materials::{Material, Materials};
pub use point_octree::{Ellipses, PointOctree, Selected, Selection};
pub use pose::{Pose, Span};
pub use primitives::{Model, Parts, Primitives};
pub use quantity::Quantity;
pub use quantized::SurfelFormat;
pub(crate) use quantized::{CLUSTER, Lattice, Quantized, RADIUS_ROUNDING};
pub use strips::{Lined, ToLines};
pub use surfels::{Colours, Ellipse, Surfels};
pub use texture::{MipMap, Texture};
#[cfg(feature = "estimate")]
pub(crate) use texture_detail::TextureDetail;
#[cfg(all(feature = "estimate", feature = "io"))]
pub(crate) use usual_extent::usual_box;
#[cfg(any(feature = "estimate", feature = "io"))]
pub(crate) use usual_extent::usual_extent;
pub(crate) use valid::is_unit;
pub use viewpoints::Viewpoints;
pub(crate) use weights::square_axis;
pub use weights::{Corners, Weights, first_axis};
