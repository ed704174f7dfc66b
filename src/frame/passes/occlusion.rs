//! Occlusion: distances → ambient occlusion of blocks of 2 × 2 pixels (bavoil2008, jimenez2016; `occlusion.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{Depth, Occlusion};
use crate::vk::shaders::OCCLUSION_COMPUTE;

/// One invocation per block of 2 × 2 pixels.
pub static OCCLUSION: Pass = Pass {
    name: "occlusion",
    reads: &[Depth],
    writes: &[Occlusion],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&OCCLUSION_COMPUTE, Domain::Quads)]),
    commands: Commands::Dispatches,
};
