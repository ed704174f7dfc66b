//! Tiles: visibility → the farthest visible surface of each tile (`tiles.glsl`), so that the computed attribute pass skips what is hidden whole.

use crate::frame::pass::{Commands, Over, Pass, Program, Programs};
use crate::frame::resource::Resource::{Tiles, Visibility};
use crate::vk::shaders::TILES_COMPUTE;

/// An invocation a tile.
pub static TILES: Pass = Pass {
    name: "tiles",
    reads: &[Visibility],
    writes: &[Tiles],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&TILES_COMPUTE, Over::Tiles)]),
    commands: Commands::Dispatches,
};
