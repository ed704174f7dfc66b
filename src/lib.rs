//! **surfel** renders point-sampled surfaces with Vulkan.
pub mod error;
mod frame;
pub mod geometry;
pub mod io;
pub mod methods;
pub mod passes;
pub mod picture;
mod readback;
pub mod reference;
pub mod renderer;
pub mod scene;
pub mod scenes;
pub mod settings;
pub mod targets;
pub mod variant;
pub mod vk;

pub use error::{Error, Result};
pub use picture::Picture;
pub use renderer::{FrameReport, RenderOptions, Renderer, SplatCounts};
pub use scene::Scene;
pub use settings::Settings;
pub use variant::{Outputs, Precision, Rasterizer};
