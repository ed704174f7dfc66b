//! Lists of tiles for indirect dispatches (`lib/tile_list.glsl`): those that splats may cover, those that splats that face away may change,
//! those with edges, and those that revealed clusters may change.

use super::resource::Resource;
use super::target_descriptions::{Kind, TargetDescription};
use super::variant::Variant;
use crate::settings::splatting::Visibility;
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

/// Covered tiles as a target.
pub const COVERED: TargetDescription =
    TargetDescription { resource: Resource::CoveredTiles, shader: Some(&resource::COVERED_TILES), ..OPEN };

/// Tiles with edges as a target.
pub const EDGES: TargetDescription =
    TargetDescription { resource: Resource::EdgeTiles, shader: Some(&resource::EDGE_TILES), ..OPEN };

/// Tiles of revealed clusters as a target.
pub const REVEALED: TargetDescription =
    TargetDescription { resource: Resource::RevealedTiles, shader: Some(&resource::REVEALED_TILES), ..OPEN };

impl Variant {
    /// Whether dispatches over lists of tiles draw the picture; otherwise over rectangles of tiles, stage by stage.
    pub fn lists_tiles(&self) -> bool {
        self.is_tiled() && !self.sliced && (!self.split || self.visibility == Visibility::Nearest)
    }

    /// Whether surface draws first the splats that face the eye, then again the tiles that others may change.
    pub fn opens_tiles(&self) -> bool {
        let whole = self.is_tiled() && !self.split && self.visibility != Visibility::Nearest;
        whole && self.cull_auto
    }
}

/// The listed tiles of a list with these bytes, column and row of each.
pub fn listed(bytes: &[u8]) -> Vec<[u32; 2]> {
    let words: Vec<u32> = bytemuck::pod_collect_to_vec(bytes);
    let (header, tiles) = words.split_at((HEADER / 4) as usize);
    let listed = tiles.iter().skip(1).step_by(2).take(header[3] as usize);
    listed.map(|tile| [tile & 0xffff, tile >> 16]).collect()
}

/// Bytes of the list of a picture of so many tiles.
pub fn bytes(tiles: u64) -> u64 {
    HEADER + ENTRY * tiles
}
