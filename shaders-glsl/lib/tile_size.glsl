#ifndef LIB_TILE_SIZE
#define LIB_TILE_SIZE

// Side of a tile, px, and its binary logarithm.
const uint TILE_BITS = 3, TILE = 1u << TILE_BITS;

#endif
