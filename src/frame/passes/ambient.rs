//! Ambient: the picture, its distances and its ambient occlusion → the picture, darkened by it (`ambient.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{Depth, Image, Occlusion};
use crate::vk::shaders::AMBIENT_COMPUTE;

/// One invocation per corner of blocks of 2 × 2 pixels.
pub static AMBIENT: Pass = Pass {
    name: "ambient",
    reads: &[Depth, Occlusion],
    writes: &[Image],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&AMBIENT_COMPUTE, Domain::Quads)]),
    commands: Commands::Dispatches,
};
