//! Open: tiles that `sides` has opened → list of them, for the second dispatch of `surface` (`open.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::OpenTiles;
use crate::vk::shaders::OPEN_COMPUTE;

/// One invocation per tile.
pub static OPEN: Pass = Pass {
    name: "open",
    reads: &[],
    writes: &[OpenTiles],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&OPEN_COMPUTE, Domain::TileSlots)]),
    commands: Commands::Dispatches,
};
