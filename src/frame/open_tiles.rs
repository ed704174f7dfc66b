//! The list of open tiles: those that splats that face away may change (`lib/open_tiles.glsl`).

use super::resource::Resource;
use super::targets::{Kind, TargetDescription};
use crate::vk::shaders::layout::OpenTile;
use crate::vk::shaders::resource;
use ash::vk::Format;

/// Bytes before the tiles: workgroups of the dispatch over the open ones, their number, and whether all are open.
pub const HEADER: u64 = 20;
/// Bytes of a tile.
pub const ENTRY: u64 = size_of::<OpenTile>() as u64;

/// Its description as a target.
pub const TARGET: TargetDescription = TargetDescription {
    resource: Resource::OpenTiles,
    format: Format::R32_UINT,
    kind: Kind::Tiles,
    shader: Some(&resource::OPEN_TILES),
};

/// Bytes of the list of a picture of so many tiles.
pub fn bytes(tiles: u64) -> u64 {
    HEADER + ENTRY * tiles
}
