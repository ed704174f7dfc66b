// Tiles with pixels at edges, which show the surface behind in samples that the nearest one leaves free: pass behind.

#include "lib/tile_list.glsl"

TILE_LIST(buffer EdgeTiles, edges, 25)
