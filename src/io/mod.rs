//! Files in and out.

pub mod srgb;
