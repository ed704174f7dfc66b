//! What several integration tests share.

pub mod gpu;
pub mod sampling;
pub mod scenes;
