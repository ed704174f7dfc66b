//! Frames: what a frame is, what it is made with, and how its passes are recorded.
//!
//! ```text
//! scenes, camera, settings ─ description → variant, uniforms ─ resources → pipelines, targets, scene resources ─ recording → commands
//! ```
//!
//! [`Renderer`] renders frames and waits for them; [`embed`](crate::embed) records them into those of a host. A method lists its passes
//! (`methods`), a pass says of itself what it runs, reads and writes (`passes`), and all else follows from that.
//!
//! # How to add a pass
//!
//! 1. `shaders-glsl/NAME.glsl`: the shader. What it reads and writes is declared at the set and binding that its name has in all shaders: 0 the
//!    scene's, or the view's numbers; 1 the targets; 2 the pyramid that is written; 3 the one that is read. `readonly` tells reads from writes.
//!    Specialization constants are those of `Variant::constants`; numbers of the frame are in `Frame` (`lib/frame.glsl`). `tools/shaders`
//!    compiles it; until then the build stops.
//! 2. `frame/passes/NAME.rs`: a static `Pass` of that name: what it reads, what it writes (and maybe reads) and clears, its programs (shader, what
//!    they run over) and whether they are dispatched or drawn. Layouts, barriers, label and timer follow; a test compares it with what the shader
//!    declares.
//! 3. `frame/methods/METHOD.rs`: its place among the method's passes, for each path that has it. After `normalize`, `surface` and `shade` a
//!    pass works on `Image`, a storage image on the compute path; the raster path's is not seen by later passes.
//! 4. `verify/reference/NAME.rs`, of pull–push `verify/reference/pull_push/NAME.rs`: the same in float64, called where the reference makes a pixel.
//! 5. `tests/engine/NAME.rs`: holds a picture to the reference.
//!
//! A setting that chooses it is a field of [`Settings`](crate::Settings), of `Variant` where a frame may lack the pass, an option, and a field of reports
//! and of what the window remembers.
//!
//! A buffer or an image that it hands on is a `Resource`, with a row in the table of targets.
#![doc = include_str!("needs.md")]

mod compact;
mod crowding;
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
pub(crate) mod resource;
pub(crate) mod resources;
mod scene_cache;
pub(crate) mod scene_resources;
mod splat_buffers;
pub(crate) mod splat_list;
pub(crate) mod targets;
pub mod times;
pub(crate) mod uniforms;
pub(crate) mod variant;

pub use plan::FramePlan;
pub use pyramid_samples::{PyramidLevel, PyramidSample};
pub use renderer::{FrameReport, RenderOptions, Renderer, Splat, SplatCounts};
pub use targets::TargetInfo;
