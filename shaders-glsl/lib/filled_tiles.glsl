// Filled tiles: those in which push may fill pixels of listed levels. In all others these stay empty.

#include "lib/pyramid_tiles.glsl"

#ifndef FILLED_ACCESS
#define FILLED_ACCESS readonly
#endif
PYRAMID_TILE_LIST(FILLED_ACCESS buffer FilledTiles, filled, 31)
