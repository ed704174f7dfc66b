//! Frames: their description, resources and recording.
//!
//! ```text
//! scenes, camera, settings ─ description → variant, uniforms ─ resources → pipelines, targets, scene resources ─ recording → commands
//! ```
//!
//! [`Renderer`] renders frames and waits for them; [`embed`](crate::embed) records them into the frames of a host. A method lists its passes
//! (`methods`); a pass declares what it runs, reads and writes (`passes`). Everything else follows from these declarations.
//!
//! # How to add a pass
//!
//! 1. `shaders-glsl/NAME.glsl`: the shader. A resource has the same set and binding in all shaders: set 0 belongs to the scene, or to the
//!    frame; 1 has the targets; 2 the pyramid that is written; 3 the one that is read. `readonly` tells reads from writes. Specialization
//!    constants are those of `Variant::constants`; uniforms of the frame are in `Frame` (`lib/frame.glsl`). `tools/shaders` compiles it; until
//!    then the build fails.
//! 2. `frame/passes/NAME.rs`: a static `Pass` of that name: the resources that it reads, writes and clears, its programs (shader and domain),
//!    and whether they are dispatches or draws. Layouts, barriers, label and timer follow; a test compares it with the shader's declarations.
//! 3. `frame/methods/METHOD.rs`: its position among the method's passes, on each path. Passes after `normalize`, `surface` and
//!    `shade` can modify `Image`, on the compute path; on the raster path only if `raster_targets` makes it an image that is stored, too, as for
//!    `ambient`, `edl` and `filter`.
//! 4. `verify/reference/NAME.rs`, of pull–push `verify/reference/pull_push/NAME.rs`: the same pass in float64, called where the reference
//!    computes a pixel.
//! 5. `tests/engine/NAME.rs`: compares pictures with the reference.
//!
//! A setting that selects it is a field of [`Settings`](crate::Settings), of `Variant` if it adds or removes the pass, a command-line option, and
//! a field of reports and of the viewer's saved settings.
//!
//! A buffer or image that it hands to other passes is a `Resource`, described in the table of targets.
#![doc = include_str!("needs.md")]

mod compact;
pub(crate) mod description;
mod distinct;
pub mod faster;
mod group_culling;
mod list_layout;
mod list_range;
mod methods;
mod normal_fields;
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
pub(crate) mod scene_variant;
pub(crate) mod selection;
mod slicing;
mod splat_buffers;
pub(crate) mod splat_list;
mod surfel_order;
pub(crate) mod target_descriptions;
pub(crate) mod targets;
mod tile_list;
mod tile_rect;
mod tile_workgroup;
pub mod times;
mod traffic;
pub(crate) mod uniforms;
pub(crate) mod variant;
pub(crate) mod variant_resources;
mod visible_clusters;

pub use plan::FramePlan;
pub use pyramid_samples::{PyramidLevel, PyramidSample};
pub use renderer::{FrameReport, RenderOptions, Renderer, Splat, SplatCounts};
pub use targets::TargetInfo;
pub use traffic::PassTraffic;
