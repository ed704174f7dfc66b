// Lists of tiles for indirect dispatches of a workgroup per tile: pass open lists the marked ones, pass covered those that splats may cover;
// lib/pyramid_tiles.glsl has those of pull–push.

#ifndef LIB_TILE_LIST
#define LIB_TILE_LIST

#include "lib/tile_size.glsl"

struct ListedTile {
    uint key;    // of each tile, row by row: MARKED, or below
    uint listed; // the listed tiles, in any order: x in the lower 16 bits, y in the upper ones
};

// A list, after the workgroups of an indirect dispatch of one per listed tile.
#define TILE_LIST(BUFFER, NAME, BINDING)                         \
    layout(set = 1, binding = BINDING, std430) BUFFER {          \
        uint columns;                                            \
        uint rows;                                               \
        uint layers;                                             \
        uint listed_count;                                       \
        uint all; /* 1: all tiles are listed */                  \
        ListedTile tiles[];                                      \
    } NAME;

// First pixel of the workgroup's tile in a list; outside the viewport in workgroups beyond the list.
#define LISTED_ORIGIN(NAME) \
    (list_place() < NAME.listed_count ? origin_of(NAME.tiles[list_place()].listed) : uvec2(1u << 30))

// The tile is marked. As a float it is not a number.
const uint MARKED = ~0u;
// Most columns of the dispatch, which every device allows.
const uint MOST_COLUMNS = 32768;

uvec2 tile_counts() {
    return (uvec2(frame.viewport) + TILE - 1) / TILE;
}

uint tile_index(uvec2 tile) {
    return tile.y * tile_counts().x + tile.x;
}

// Listed tiles that successive workgroups draw; neighbours share cache lines.
const uint RUN = 16;

// Columns of the dispatch, in so many rows, over a list of this length.
uint columns_of(uint count, uint rows) {
    return ((count + rows - 1) / rows + RUN - 1) / RUN * RUN;
}

// Place of the workgroup in the list: even runs first, then odd ones, so that devices that split dispatches into halves balance the load.
uint list_place() {
    uint runs = gl_NumWorkGroups.x * gl_NumWorkGroups.y / RUN, half_way = (runs + 1) / 2;
    uint i = gl_NumWorkGroups.x * gl_WorkGroupID.y + gl_WorkGroupID.x, run = i / RUN;
    return RUN * (run < half_way ? 2 * run : 2 * (run - half_way) + 1) + i % RUN;
}

uvec2 origin_of(uint listed) {
    return TILE * uvec2(listed & 0xffffu, listed >> 16);
}

#endif
