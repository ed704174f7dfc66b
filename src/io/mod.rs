//! Files in and out.

pub mod atomic;
pub mod colour_bar;
pub mod image;
pub mod ply;
