// Open: lists the tiles that sides has opened, for the second dispatch of surface.
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/open_tiles.glsl"

layout(local_size_x = 64) in;

void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uvec2 counts = tile_counts();
    uint all_tiles = counts.x * counts.y, rows = (all_tiles + MOST_COLUMNS - 1) / MOST_COLUMNS;
    if (i == 0) {
        open.rows = rows;
        open.layers = 1;
    }
    if (i >= all_tiles || open.all == 0 && open.tiles[i].key != OPEN) return;
    uint place = atomicAdd(open.listed_count, 1);
    atomicMax(open.columns, place / rows + 1);
    open.tiles[place].listed = i % counts.x | i / counts.x << 16;
}

#endif
