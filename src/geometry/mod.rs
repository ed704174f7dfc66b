//! What a scene is made of, as plain CPU data: nothing here knows Vulkan.

mod bounds;
mod camera;
mod cloud;
pub mod estimate;
mod merge;
mod morton;
mod surfels;

pub use bounds::Bounds;
pub use camera::{Camera, Projection};
pub use cloud::{Cloud, View};
pub use surfels::{Colours, Ellipse, Surfels};
