//! Options of a renderer in a host.

use super::Target;
use crate::settings::{Precision, RasterizerChoice};

/// Options of a [`Renderer`](super::Renderer).
#[derive(Clone, Debug)]
pub struct Options {
    /// The pass in which the picture is drawn.
    pub target: Target,
    /// Number of calls of [`Renderer::prepare`](super::Renderer::prepare) in flight: when it is called, the GPU has finished all but the last
    /// `frames_in_flight` − 1 frames that were prepared without an error. From 1 to 64. A host with two frames in flight that prepares two
    /// views in each with one renderer gives 4.
    pub frames_in_flight: u32,
    /// See [`RenderOptions::precision`](crate::frame::RenderOptions::precision).
    pub precision: Precision,
    /// See [`RenderOptions::rasterizer`](crate::frame::RenderOptions::rasterizer).
    pub rasterizer: RasterizerChoice,
    /// See [`RenderOptions::most_splats`](crate::frame::RenderOptions::most_splats). With `None`, a tile of one frame may lack splats on
    /// devices that stop long loops, as lavapipe does ([`Capabilities::limited_loops`](crate::vk::Capabilities::limited_loops)): see [`Renderer::is_incomplete`](super::Renderer::is_incomplete).
    pub most_splats: Option<u32>,
}

impl Options {
    /// Two frames in flight, full precision, the rasterizer chosen automatically, no bound on the work of a frame.
    pub fn new(target: Target) -> Self {
        Self {
            target,
            frames_in_flight: 2,
            precision: Precision::Full,
            rasterizer: RasterizerChoice::Automatic,
            most_splats: None,
        }
    }
}
