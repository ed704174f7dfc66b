//! Open: marked tiles → list of them, for a dispatch over these (`open.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{CoveredTiles, EdgeTiles, OpenTiles, RevealedTiles};
use crate::vk::shaders::{OPEN_COMPUTE, OPEN_EDGES_COMPUTE, OPEN_REVEALED_COMPUTE};

/// One invocation per tile: those that `sides` has opened, for the second dispatch of `surface`; they are covered from then on.
pub static OPEN: Pass = Pass {
    name: "open",
    reads: &[],
    writes: &[OpenTiles, CoveredTiles],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&OPEN_COMPUTE, Domain::TileSlots)]),
    commands: Commands::Dispatches,
};

/// The same for those with edges, for `behind`.
pub static EDGES: Pass = Pass {
    name: "open",
    reads: &[],
    writes: &[EdgeTiles],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&OPEN_EDGES_COMPUTE, Domain::TileSlots)]),
    commands: Commands::Dispatches,
};

/// The same for those of revealed clusters, which are drawn again before `sides`.
pub static REVEALED: Pass = Pass {
    name: "open",
    reads: &[],
    writes: &[RevealedTiles, CoveredTiles],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&OPEN_REVEALED_COMPUTE, Domain::TileSlots)]),
    commands: Commands::Dispatches,
};
