//! EDL: the picture and its depths → the picture under eye-dome lighting (boucheny2009; `edl.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{Depth, Image};
use crate::vk::shaders::EDL_COMPUTE;

/// One invocation per pixel.
pub static EDL: Pass = Pass {
    name: "edl",
    reads: &[Depth],
    writes: &[Image],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&EDL_COMPUTE, Domain::Pixels)]),
    commands: Commands::Dispatches,
};
