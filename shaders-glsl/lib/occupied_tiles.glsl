// Occupied tiles: those with a nearest point. The others are not marked.

#include "lib/pyramid_tiles.glsl"

#ifndef OCCUPIED_ACCESS
#define OCCUPIED_ACCESS readonly
#endif
PYRAMID_TILE_LIST(OCCUPIED_ACCESS buffer OccupiedTiles, occupied, 30)
