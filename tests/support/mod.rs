//! What several integration tests share.

pub mod sampling;
pub mod scenes;
