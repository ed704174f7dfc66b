#ifndef LIB_TILE_SIZE
#define LIB_TILE_SIZE

// Side of a tile, px.
const uint TILE = 8;

#endif
