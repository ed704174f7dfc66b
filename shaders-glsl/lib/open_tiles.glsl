// Open tiles: those that splats that face away may change, once pass sides has culled some of these. They are drawn again, with all splats.

#include "lib/tile_size.glsl"

struct OpenTile {
    uint key;    // of each tile, row by row: bits of the κ behind which splats do not change it, or OPEN
    uint listed; // the open tiles, in any order: x in the lower 16 bits, y in the upper ones
};

// The tiles, after the workgroups of an indirect dispatch of one per open tile, column by column.
layout(set = 1, binding = 24, std430) buffer OpenTiles {
    uint columns;
    uint rows;
    uint layers;
    uint listed_count;
    uint all; // 1: all tiles are open
    OpenTile tiles[];
} open;

// The tile is open. As a float it is not a number.
const uint OPEN = ~0u;
// Most columns of the dispatch, which every device allows.
const uint MOST_COLUMNS = 32768;

uvec2 tile_counts() {
    return (uvec2(frame.viewport) + TILE - 1) / TILE;
}

uint tile_index(uvec2 tile) {
    return tile.y * tile_counts().x + tile.x;
}

// First pixel of the workgroup's tile; outside the viewport in workgroups beyond the list.
uvec2 listed_origin() {
    uint place = gl_WorkGroupID.x * gl_NumWorkGroups.y + gl_WorkGroupID.y;
    bool exists = place < open.listed_count;
    uint tile = open.tiles[exists ? place : 0].listed;
    return exists ? TILE * uvec2(tile & 0xffffu, tile >> 16) : uvec2(1u << 30);
}
