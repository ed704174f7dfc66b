//! Files in and out.

mod atomic;
pub mod ply;
pub mod srgb;
