//! **surfel** renders point-sampled surfaces with Vulkan: scans, photogrammetry, simulations.
//!
//! The way of the data, and where each step lives:
//!
//! ```text
//! file ─ formats, estimate → geometry ─ scene → buffers ─ frame: methods, passes → targets → picture
//! ```
//!
//! Layer by layer, from the lowest; none imports what stands below it here.
//!
//! | module | | feature |
//! |---|---|---|
//! | [`vk`] | the layer over raw Vulkan | `window` for presenting |
//! | [`geometry`] | what a scene is made of: surfels, lines, triangles, bounds, cameras; plain CPU data | |
//! | [`settings`] | what a frame is asked to be: how surfels become pixels, the papers' methods, outputs; plain CPU data | |
//! | [`formats`] | PLY, PNG, EXR, cameras | `io` |
//! | [`estimate`] | normals, radii, creases, sides and lines of points that come without | `estimate` |
//! | [`scene`] | geometry on the GPU: only the streams that it has, where it is placed | |
//! | [`verify`] | what pictures are held to: [`reference`](mod@verify::reference), the float64 twin of every pass; [`truth`](verify::truth), exact images; [`metrics`](verify::metrics) of error; [`scenes`](verify::scenes) with exact surfaces; [`baseline`](verify::baseline), a native program | each by its name, the last by `bench` |
//! | [`mod@frame`] | frames: what one needs and no more, one file a pass beside the shader of the same name, recording, reading back | |
//! | [`capture`] | normalization weights of surfels, from pictures of them | `reference` |
//! | [`embed`] | the same frames within those of another renderer | |
//! | [`bench`](mod@bench) | speed against error | `bench` |
//! | [`guide`] | the manual: files, commands, methods, accuracy, cost, embedding | |
//!
//! ```no_run
//! use surfel::geometry::{Camera, Extent};
//! use surfel::glam::DVec3;
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
//! let camera = Camera::framing(&extent, DVec3::Y, 45f64.to_radians(), 800.0 / 600.0)?;
//! let (picture, _report) = renderer.render_picture(&scene, &camera, &Settings::default())?;
//! assert_eq!(picture.colour.len(), 800 * 600);
//! # Ok(())
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
