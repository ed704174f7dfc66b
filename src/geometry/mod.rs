//! What a scene is made of, as plain CPU data: nothing here knows Vulkan.

mod bounds;
mod camera;
mod merge;
mod morton;
mod surfels;

pub use bounds::Bounds;
pub use camera::{Camera, Projection};
pub use surfels::{Colours, Surfels};
