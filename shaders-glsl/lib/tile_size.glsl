#ifndef LIB_TILE_SIZE
#define LIB_TILE_SIZE

// Side of a tile, px, and its binary logarithm; with PYRAMID_TILES, of those of lib/pyramid_tiles.glsl.
#ifdef PYRAMID_TILES
const uint TILE_BITS = 4;
#else
const uint TILE_BITS = 3;
#endif
const uint TILE = 1u << TILE_BITS;

#endif
