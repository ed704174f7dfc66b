//! Resolve: the number of each pixel's nearest splat → what it is (`resolve.glsl`), for the computed nearest pass.

use crate::frame::pass::{Commands, Over, Pass, Program, Programs};
use crate::frame::resource::Resource::{Splats, Sums0, Sums1, Visibility};
use crate::vk::shaders::RESOLVE_COMPUTE;

/// An invocation a pixel, for each part of a scene: the pixels of one's splats are not another's, so that their order does not matter. The first
/// part of the first scene clears what nobody's are.
pub static RESOLVE: Pass = Pass {
    name: "resolve",
    reads: &[Splats, Visibility],
    writes: &[Sums0, Sums1],
    clears: &[],
    programs: Programs::OfScene(|_| vec![Program::compute(&RESOLVE_COMPUTE, Over::PixelsOfSurfels)]),
    commands: Commands::Dispatches,
};

/// What is done instead in a frame without scenes.
pub static EMPTY: Pass = Pass {
    name: "resolve",
    reads: &[],
    writes: &[Sums0, Sums1],
    clears: &[Sums0, Sums1],
    programs: Programs::None,
    commands: Commands::Dispatches,
};
