//! **surfel** renders point-sampled surfaces with Vulkan.
pub mod error;
pub mod geometry;
pub mod io;
pub mod picture;
pub mod reference;
pub mod scenes;
pub mod settings;

pub use error::{Error, Result};
pub use picture::Picture;
pub use settings::Settings;
