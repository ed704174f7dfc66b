//! **surfel** renders point-sampled surfaces with Vulkan: scans, photogrammetry, simulations.
//!
//! The way of the data, and where each step lives:
//!
//! ```text
//! file ─ io, scenes → geometry ─ scene → buffers ─ frame: methods, passes → targets → picture
//! ```
//!
//! | module | | feature |
//! |---|---|---|
//! | [`geometry`] | what a scene is made of: surfels, lines, triangles, bounds, cameras; plain CPU data | `estimate` for its module of that name |
//! | [`io`] | PLY, PNG, EXR | `io` |
//! | [`scenes`] | built-in scenes with exact ground truth | `scenes` |
//! | [`settings`], [`splatting`] | what a frame is asked to be, and how surfels become pixels | |
//! | [`scene`] | geometry on the GPU: only the streams that it has | |
//! | [`instance`] | scenes where they are placed: several in a frame | |
//! | [`methods`] | the methods: their papers, and what each chooses | |
//! | [`mod@frame`] | frames: what one needs and no more, one file a pass beside the shader of the same name, recording, reading back | |
//! | [`embed`] | the same frames within those of another renderer | |
//! | [`times`] | statistics of how long frames and passes take | |
//! | [`capture`] | normalization weights of surfels, from pictures of them | `reference` |
//! | [`reference`](mod@reference) | the float64 twin of every pass, on the CPU; judges pictures | `reference` |
//! | [`truth`] | exact images: rays against the surface itself | `truth` |
//! | [`metrics`] | how far a picture is from the truth | `metrics` |
//! | [`yardstick`] | the same frames by a plain native program: what times are multiples of | `bench` |
//! | [`bench`](mod@bench) | speed against error | `bench` |
//! | [`vk`] | the layer over raw Vulkan | `window` for presenting |
//!
//! ```no_run
//! use surfel::geometry::Camera;
//! use surfel::geometry::estimate::Estimate;
//! use surfel::vk::{Device, DeviceOptions};
//! use surfel::{Error, RenderOptions, Renderer, Scene, Settings, io};
//!
//! # fn main() -> surfel::Result<()> {
//! let loaded = io::ply::read("bunny.ply".as_ref(), &Default::default(), &())?;
//! let (surfels, _) = loaded.cloud.into_surfels(&Estimate::default(), &()).map_err(|cause| Error::input("bunny.ply", cause))?;
//! let device = Device::open(&DeviceOptions::default())?;
//! let scene = Scene::upload(&device, &surfels)?;
//! let mut renderer = Renderer::new(&device, RenderOptions { size: [800, 600], ..Default::default() })?;
//! let camera = Camera::framing(&scene.bounds(), 45f64.to_radians(), 800.0 / 600.0)?;
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
pub mod frame;
pub mod geometry;
pub mod instance;
#[cfg(feature = "io")]
pub mod io;
mod memory;
pub mod methods;
#[cfg(feature = "metrics")]
pub mod metrics;
pub mod picture;
mod progress;
pub mod pull_push;
#[cfg(feature = "reference")]
pub mod reference;
pub mod scene;
#[cfg(feature = "scenes")]
pub mod scenes;
pub mod settings;
pub mod splatting;
pub mod times;
#[cfg(feature = "truth")]
pub mod truth;
pub mod vk;
#[cfg(feature = "bench")]
pub mod yardstick;

/// The version of ash whose handles [`embed`] takes.
pub use ash;
pub use error::{Error, Result};
pub use frame::{
    FrameReport, Outputs, Precision, PyramidLevel, PyramidSample, Rasterizer, RenderOptions, Renderer,
    SplatCounts, TargetInfo,
};
/// The version of glam whose vectors and matrices the interface takes.
pub use glam;
pub use instance::{Instance, Instances};
pub use picture::Picture;
pub use progress::Progress;
pub use scene::Scene;
pub use settings::Settings;
