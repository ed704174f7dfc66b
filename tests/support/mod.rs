//! What several integration tests share; none uses all of it.
#![allow(dead_code)]

pub mod gpu;
pub mod layouts;
pub mod mesh;
pub mod placing;
pub mod pyramids;
pub mod sampling;
pub mod scenes;
pub mod texture;
