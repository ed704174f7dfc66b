//! Filter: the lit picture → the picture convolved with a Gaussian, over the background (zwicker2004 equation 3, after light; `filter.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{CoveredTiles, Filtered, Image};
use crate::vk::shaders::{FILTER_COMPUTE, FILTER_COVERED_COMPUTE};

/// One invocation per block of pixels.
pub static FILTER: Pass = Pass {
    name: "filter",
    reads: &[Image],
    writes: &[Filtered],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&FILTER_COMPUTE, Domain::Blocks)]),
    commands: Commands::Dispatches,
};

/// The same where only covered tiles of the picture are written; leaves the background in blocks without any.
pub static IN_COVERED_TILES: Pass = Pass {
    name: "filter",
    reads: &[Image, CoveredTiles],
    writes: &[Filtered],
    clears: &[Filtered],
    programs: Programs::OfFrame(|_| vec![Program::compute(&FILTER_COVERED_COMPUTE, Domain::Blocks)]),
    commands: Commands::Dispatches,
};
