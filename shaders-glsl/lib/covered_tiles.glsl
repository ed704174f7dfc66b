// Covered tiles: those that boxes of splats overlap. They are marked, and so are tiles that later dispatches draw. Others stay empty.

#include "lib/tile_list.glsl"

#ifndef COVERED_ACCESS
#define COVERED_ACCESS readonly
#endif
TILE_LIST(COVERED_ACCESS buffer CoveredTiles, covered, 29)
