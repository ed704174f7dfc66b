//! Filter: the lit picture → the picture convolved with a Gaussian, over the background (zwicker2004 equation 3, after light; `filter.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{Filtered, Image};
use crate::vk::shaders::FILTER_COMPUTE;

/// One invocation per block of pixels.
pub static FILTER: Pass = Pass {
    name: "filter",
    reads: &[Image],
    writes: &[Filtered],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&FILTER_COMPUTE, Domain::Blocks)]),
    commands: Commands::Dispatches,
};
