//! Lists of tiles for indirect dispatches (`lib/tile_list.glsl`): those that splats that face away may change, those with edges, and those
//! that revealed clusters may change.

use super::resource::Resource;
use super::target_descriptions::{Kind, TargetDescription};
use crate::vk::shaders::layout::ListedTile;
use crate::vk::shaders::resource;
use ash::vk::Format;

/// Bytes before the tiles: workgroups of the dispatch over the listed ones, their number, and whether all are listed.
pub const HEADER: u64 = 20;
/// Bytes of a tile.
pub const ENTRY: u64 = size_of::<ListedTile>() as u64;

/// Open tiles as a target.
pub const OPEN: TargetDescription = TargetDescription {
    resource: Resource::OpenTiles,
    format: Format::R32_UINT,
    kind: Kind::Tiles,
    shader: Some(&resource::OPEN_TILES),
};

/// Tiles with edges as a target.
pub const EDGES: TargetDescription =
    TargetDescription { resource: Resource::EdgeTiles, shader: Some(&resource::EDGE_TILES), ..OPEN };

/// Tiles of revealed clusters as a target.
pub const REVEALED: TargetDescription =
    TargetDescription { resource: Resource::RevealedTiles, shader: Some(&resource::REVEALED_TILES), ..OPEN };

/// Bytes of the list of a picture of so many tiles.
pub fn bytes(tiles: u64) -> u64 {
    HEADER + ENTRY * tiles
}
