// Filled: lists the pyramid tiles that the last steps of push may fill, for dispatches over these.
//
// A pixel of levels 0 to 3 is filled from pulled pixels beside it and from the four nearest final pixels of the coarser level. By induction from
// level 4, of which a pixel is a tile, all of these lie in its tile and the eight around it. If none of the nine has a point, or a final sample
// on level 4, nothing in the tile is filled.
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pyramid.glsl"
#include "lib/level.glsl"
#include "lib/occupied_tiles.glsl"
#define FILLED_ACCESS
#include "lib/filled_tiles.glsl"

PYRAMID_TO_READ(2, final)

layout(local_size_x = 64) in;

// Whether a tile has points, or its pixel of level 4 a final sample.
bool has_samples(ivec2 tile) {
    if (!is_within(ivec2(tile_counts()), tile)) return false;
    bool has_final = is_within(pass.size, tile) && load_final(pass.from_origin + tile).near > 0.0;
    return has_final || occupied.tiles[tile_index(uvec2(tile))].key == MARKED;
}

void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i == 0) BEGIN_LIST(filled)
    uvec2 counts = tile_counts(), tile = uvec2(i % counts.x, i / counts.x);
    if (tile.y >= counts.y) return;
    bool found = false;
    for (int k = 0; k < 9 && !found; k++) found = has_samples(ivec2(tile) + ivec2(k % 3, k / 3) - 1);
    if (found) LIST_TILE(filled, tile)
}

#endif
