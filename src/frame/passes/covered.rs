//! Covered: boxes of splats → list of the tiles that they overlap, for a dispatch over these (`covered.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{Boxes, CoveredTiles};
use crate::vk::shaders::{COVERED_COMPUTE, COVERED_SUBGROUPS_COMPUTE};

/// One invocation per strip of tiles.
pub static COVERED: Pass = Pass {
    name: "covered",
    reads: &[Boxes],
    writes: &[CoveredTiles],
    clears: &[CoveredTiles],
    programs: Programs::OfFrame(|variant| {
        let modules = [&COVERED_COMPUTE, &COVERED_SUBGROUPS_COMPUTE];
        vec![Program::compute(modules[usize::from(variant.workgroup.subgroups)], Domain::TileStrips)]
    }),
    commands: Commands::Dispatches,
};
