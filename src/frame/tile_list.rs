//! Lists of tiles for indirect dispatches (`lib/tile_list.glsl`): those that splats may cover, those that splats that face away may change,
//! those with edges, and those that revealed clusters may change; of pull–push (`lib/pyramid_tiles.glsl`), those with points, and those that push
//! may fill.

use super::resource::Resource;
use super::target_descriptions::{Kind, TargetDescription};
use super::variant::Variant;
use crate::settings::splatting::Visibility;
use crate::vk::shaders::layout::ListedTile;
use crate::vk::shaders::resource;
use ash::vk::Format;

/// Bytes before the tiles: workgroups of the dispatch over the listed ones, their number, and whether all are listed.
pub const HEADER: u64 = 20;
/// The same of a list of pyramid tiles: workgroups of a dispatch per level, and the number of tiles.
pub const PYRAMID_HEADER: u64 = 12 * LISTED_LEVELS as u64 + 4;
/// Levels of pull–push that run over lists, from 0 on.
pub const LISTED_LEVELS: u32 = 3;
/// Level of pull–push of which a pixel is a pyramid tile.
pub const TILE_LEVEL: u32 = 4;
/// Side of a pyramid tile, px.
pub const PYRAMID_TILE: u32 = 1 << TILE_LEVEL;
/// Workgroups of a dispatch over level 0 per pyramid tile.
const WORKGROUPS_PER_TILE: u64 = 4;
/// Workgroups that visit successive tiles (`lib/tile_list.glsl`).
const RUN: u64 = 16;
/// Most columns of a dispatch over a list.
const MOST_COLUMNS: u64 = 32_768;
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

/// Pyramid tiles with points as a target.
pub const OCCUPIED: TargetDescription = TargetDescription {
    resource: Resource::OccupiedTiles,
    kind: Kind::PyramidTiles,
    shader: Some(&resource::OCCUPIED_TILES),
    ..OPEN
};

/// Pyramid tiles that push may fill as a target.
pub const FILLED: TargetDescription =
    TargetDescription { resource: Resource::FilledTiles, shader: Some(&resource::FILLED_TILES), ..OCCUPIED };

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

/// Offset in a list of pyramid tiles of the workgroups of the dispatch over a level.
pub fn workgroups_at(level: u32) -> u64 {
    12 * u64::from(level)
}

/// The listed tiles of a list with these bytes, column and row of each.
pub fn listed(bytes: &[u8]) -> Vec<[u32; 2]> {
    let words: Vec<u32> = bytemuck::pod_collect_to_vec(bytes);
    let (header, tiles) = words.split_at((HEADER / 4) as usize);
    let listed = tiles.iter().skip(1).step_by(2).take(header[3] as usize);
    listed.map(|tile| [tile & 0xffff, tile >> 16]).collect()
}

/// So many pyramid tiles, and those that dispatches over a list of all visit beyond it: up to a run of workgroups per row, of four tiles each.
pub fn with_padding(tiles: u64) -> u64 {
    tiles + 4 * (RUN + 1) * tiles.div_ceil(MOST_COLUMNS / WORKGROUPS_PER_TILE)
}

/// Bytes of the list of a picture of so many tiles, after a header of so many.
pub fn bytes(header: u64, tiles: u64) -> u64 {
    header + ENTRY * tiles
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Workgroups of the dispatch over a list, as in `lib/tile_list.glsl`: at most a run too many per row.
    fn dispatched(workgroups: u64) -> u64 {
        let rows = workgroups.div_ceil(MOST_COLUMNS);
        let columns = workgroups.div_ceil(rows).next_multiple_of(RUN);
        assert!(columns <= MOST_COLUMNS && columns * rows >= workgroups, "{workgroups}");
        columns * rows
    }

    #[test]
    fn shaders_have_the_same_numbers() {
        let lists = include_str!("../../shaders-glsl/lib/tile_list.glsl");
        assert!(lists.contains(&format!("const uint RUN = {RUN};")));
        assert!(lists.contains(&format!("const uint MOST_COLUMNS = {MOST_COLUMNS};")));
        let tiles = include_str!("../../shaders-glsl/lib/pyramid_tiles.glsl");
        assert!(tiles.contains(&format!("const uint LISTED_LEVELS = {LISTED_LEVELS};")));
        assert!(tiles.contains(&format!("level == 0 ? {WORKGROUPS_PER_TILE} * tiles : ")));
        let sizes = include_str!("../../shaders-glsl/lib/tile_size.glsl");
        assert!(sizes.contains(&format!("#ifdef PYRAMID_TILES\nconst uint TILE_BITS = {TILE_LEVEL};")));
    }

    #[test]
    fn dispatches_over_lists_stay_within_them() {
        for tiles in (1..=300_u64).chain([8_191, 8_192, 8_193, 32_768, 100_003, 1 << 20]) {
            // Workgroups of levels 0, 1 and 2, and the tiles of four of these.
            for (workgroups, of_four) in [(4 * tiles, 1), (tiles, 4), (tiles.div_ceil(4), 16)] {
                let visited = (dispatched(workgroups) * of_four).div_ceil(4);
                assert!(visited <= with_padding(tiles), "{tiles} {of_four}: {visited}");
            }
        }
    }
}
