//! **surfel** renders point-sampled surfaces with Vulkan: scans, photogrammetry, simulations.
//!
//! ```text
//! file ─ formats, estimate → geometry ─ scene → buffers ─ frame: methods, passes → targets → picture
//! ```
//!
//! Modules form layers, and none imports one that is below it in this table:
//!
//! | module | contents | feature |
//! |---|---|---|
//! | [`vk`] | Vulkan devices, their limits, and windows | `window` for presenting |
//! | [`geometry`] | surfels, lines, triangles, bounds, cameras; plain CPU data | |
//! | [`settings`] | how surfels become pixels: axes, the papers' methods, outputs; plain CPU data | |
//! | [`formats`] | readers and writers of point clouds, pictures and cameras | `io` |
//! | [`estimate`] | normals, radii, creases, sides and lines of points that come without | `estimate` |
//! | [`scene`] | geometry on the GPU: its streams, instances and updates | |
//! | [`verify`] | [`reference`](mod@verify::reference): each shader in float64; [`truth`](verify::truth): exact pictures; [`metrics`](verify::metrics) of error; [`scenes`](verify::scenes) with exact surfaces; [`baseline`](verify::baseline): splatting on the CPU | each by its name, the last by `bench` |
//! | [`mod@load`] | from files and built-in scenes to a model | `io`, `estimate` |
//! | [`mod@frame`] | frames: methods, passes, targets, recording, reading back | |
//! | [`capture`] | normalization weights of surfels, from pictures of them | `reference` |
//! | [`embed`] | the same frames within those of another renderer | |
//! | [`bench`](mod@bench) | speed against error | `bench` |
//! | [`guide`] | the manual: files, commands, methods, accuracy, cost, embedding | |
//!
//! ```no_run
//! use surfel::formats::image::{Output, write_png};
//! use surfel::geometry::{Camera, Extent};
//! use surfel::load::{LoadOptions, load};
//! use surfel::vk::{Device, DeviceOptions};
//! use surfel::{RenderOptions, Renderer, Scene, Settings};
//!
//! # fn main() -> surfel::Result<()> {
//! let loaded = load(&["bunny.ply"], &LoadOptions::default(), &())?;
//! let device = Device::open(&DeviceOptions::default())?;
//! let scene = Scene::upload(&device, &loaded.model)?;
//! let mut renderer = Renderer::new(&device, RenderOptions { size: [800, 600], ..Default::default() })?;
//! let extent = Extent::of(&loaded.model).unwrap_or_default();
//! let camera = Camera::framing(&extent, loaded.up, 45f64.to_radians(), 800.0 / 600.0)?;
//! let settings = Settings::default();
//! let (picture, _report) = renderer.render_picture(&scene, &camera, &settings)?;
//! write_png(&picture, settings.shading, &Output::parse("out.png".as_ref()))
//! # }
//! ```

// Every item is used by some feature; the lints run with all of them.
#![cfg_attr(not(all(feature = "bench", feature = "viewer")), allow(dead_code))]

#[cfg(feature = "bench")]
pub mod bench;
#[cfg(feature = "reference")]
pub mod capture;
pub mod embed;
pub mod error;
#[cfg(feature = "estimate")]
pub mod estimate;
#[cfg(feature = "io")]
pub mod formats;
pub mod frame;
pub mod geometry;
pub mod guide;
#[cfg(all(feature = "io", feature = "estimate"))]
pub mod load;
pub mod picture;
mod progress;
pub mod scene;
pub mod settings;
#[cfg(test)]
#[path = "../tests/support/skipping.rs"]
mod skipping;
pub mod verify;
pub mod vk;

/// The version of ash whose handles [`embed`] takes.
pub use ash;
pub use error::{Error, Result};
pub use frame::{FrameReport, PyramidLevel, PyramidSample, RenderOptions, Renderer, SplatCounts, TargetInfo};
/// The version of glam whose vectors and matrices the interface takes.
pub use glam;

pub use picture::Picture;
pub use progress::{Progress, thousands};
pub use scene::{Instance, Instances, Scene};
pub use settings::{Outputs, Precision, Rasterizer, RasterizerChoice, RasterizerReason, Settings};
