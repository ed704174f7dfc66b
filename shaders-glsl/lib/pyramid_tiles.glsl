// Pyramid tiles: 16 × 16 px, a pixel of level 4. Passes occupied and filled list some for the passes over levels 0 to 2 of pull–push. On level
// 1, a tile has as many pixels as a workgroup has invocations.

#ifndef LIB_PYRAMID_TILES
#define LIB_PYRAMID_TILES

#ifdef LIB_TILE_SIZE
#error "other tiles are included already"
#endif
#define PYRAMID_TILES
#include "lib/tile_list.glsl"

struct Workgroups {
    uint columns, rows, layers;
};

// Levels that run over lists.
const uint LISTED_LEVELS = 3;

// A list, after the workgroups of an indirect dispatch over its pixels of each level.
#define PYRAMID_TILE_LIST(BUFFER, NAME, BINDING)                   \
    layout(set = 1, binding = BINDING, std430) BUFFER {          \
        Workgroups workgroups[LISTED_LEVELS];                    \
        uint listed_count;                                       \
        ListedTile tiles[];                                      \
    } NAME;

// Workgroups of a dispatch over the pixels of a level, of so many tiles.
uint workgroups_of(uint tiles, uint level) {
    return level == 0 ? 4 * tiles : level == 1 ? tiles : (tiles + 3) / 4;
}

// Rows of the dispatch, whatever is listed.
uint rows_of(uint level) {
    uvec2 counts = tile_counts();
    return (workgroups_of(counts.x * counts.y, level) + MOST_COLUMNS - 1) / MOST_COLUMNS;
}

// Sets what does not depend on the listed tiles; one invocation does this.
#define BEGIN_LIST(NAME)                                                                               \
    for (uint level = 0; level < LISTED_LEVELS; level++) {                                             \
        NAME.workgroups[level].rows = rows_of(level);                                                  \
        NAME.workgroups[level].layers = 1;                                                             \
    }

// Lists a tile.
#define LIST_TILE(NAME, TILE_AT)                                                                       \
    {                                                                                                  \
        uint place = atomicAdd(NAME.listed_count, 1);                                                  \
        NAME.tiles[place].listed = TILE_AT.x | TILE_AT.y << 16;                                        \
        for (uint level = 0; level < LISTED_LEVELS; level++) {                                         \
            uint columns = columns_of(workgroups_of(place + 1, level), rows_of(level));                \
            bool grows = columns != columns_of(workgroups_of(place, level), rows_of(level));           \
            if (grows) atomicMax(NAME.workgroups[level].columns, columns);                             \
        }                                                                                              \
    }

// The invocation's place in the list of the pixels of a level, tile by tile.
uint pixel_place() {
    return list_place() * (gl_WorkGroupSize.x * gl_WorkGroupSize.y) + gl_LocalInvocationIndex;
}

// Binary logarithm of a tile's number of pixels of a level.
uint pixel_bits(uint level) {
    return 2 * (TILE_BITS - level);
}

// The invocation's pixel of a listed level; outside the picture beyond the list, whose bits are set there.
#define LISTED_PIXEL(NAME, LEVEL) pixel_of(NAME.tiles[pixel_place() >> pixel_bits(LEVEL)].listed, LEVEL)

// Row by row of the tile.
ivec2 pixel_of(uint listed, uint level) {
    uint bits = TILE_BITS - level, i = pixel_place();
    uvec2 inside = uvec2(i, i >> bits) & ((1u << bits) - 1);
    return ivec2((origin_of(listed) >> level) + inside);
}

#endif
