//! Frames: what a frame is, what it is made with, and how its passes are recorded.
//!
//! ```text
//! scenes, camera, settings ─ description → variant, uniforms ─ resources → pipelines, targets, scene resources ─ recording → commands
//! ```
//!
//! [`Renderer`] renders frames and waits for them; [`embed`](crate::embed) records them into those of a host. A method lists its passes
//! (`methods`), a pass says of itself what it runs, reads and writes (`passes`), and all else follows from that.

mod compact;
pub(crate) mod description;
mod methods;
pub(crate) mod pass;
pub(crate) mod passes;
pub(crate) mod pipelines;
mod plan;
mod pyramid_samples;
pub(crate) mod pyramids;
pub(crate) mod rasterizer;
mod readback;
pub(crate) mod recording;
mod renderer;
mod residents;
pub(crate) mod resource;
pub(crate) mod resources;
pub(crate) mod scene_resources;
pub(crate) mod targets;
pub mod times;
pub(crate) mod uniforms;
pub(crate) mod variant;

pub use plan::FramePlan;
pub use pyramid_samples::{PyramidLevel, PyramidSample};
pub use renderer::{FrameReport, RenderOptions, Renderer, Splat, SplatCounts};
pub use targets::TargetInfo;
