// Open tiles: those that splats that face away may change, once pass sides has culled some of these. They are drawn again, with all splats.
// The key of others has the bits of the κ behind which splats do not change the tile.

#include "lib/tile_list.glsl"

TILE_LIST(buffer OpenTiles, open, 24)
