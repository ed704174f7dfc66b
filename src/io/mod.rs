//! Files in and out.

mod atomic;
pub mod image;
pub mod ply;
pub mod srgb;
