// Tiles that revealed clusters may change: those that face the eye are drawn again before pass sides.

#include "lib/tile_list.glsl"

TILE_LIST(buffer RevealedTiles, revealed, 28)
