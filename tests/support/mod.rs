//! What several integration tests share; none uses all of it.
#![allow(dead_code)]

pub mod after_light;
pub mod gpu;
pub mod layouts;
pub mod matrix;
pub mod mesh;
pub mod placing;
pub mod pyramids;
pub mod results;
pub mod sampling;
pub mod scenes;
pub mod settings;
pub mod skipping;
pub mod texture;
pub mod truth;

pub use matrix::if_whole;
use surfel::settings::methods::Method;

/// All presets in the whole matrix, otherwise one of each list of passes.
pub fn methods() -> Vec<Method> {
    let some = ["perspective-ewa", "sprites-unfiltered", "confetti", "pull-push"];
    if_whole(Method::ALL.to_vec(), some.map(|name| Method::named(name).unwrap()).to_vec())
}
