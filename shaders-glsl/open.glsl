// Open: lists the marked tiles for a dispatch over these: those that sides has opened, those with edges, or those of revealed clusters.
#version 450
#pragma variant EDGES COMPUTE
#pragma variant REVEALED COMPUTE
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#ifdef EDGES
#include "lib/edge_tiles.glsl"
#define LIST edges
#else
#define COVERED_ACCESS writeonly
#include "lib/covered_tiles.glsl"
#ifdef REVEALED
#include "lib/revealed_tiles.glsl"
#define LIST revealed
#else
#include "lib/open_tiles.glsl"
#define LIST open
#endif
#endif

layout(local_size_x = 64) in;

void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uvec2 counts = tile_counts();
    uint all_tiles = counts.x * counts.y, rows = (all_tiles + MOST_COLUMNS - 1) / MOST_COLUMNS;
    if (i == 0) {
        LIST.rows = rows;
        LIST.layers = 1;
    }
    if (i >= all_tiles || LIST.all == 0 && LIST.tiles[i].key != MARKED) return;
    uint place = atomicAdd(LIST.listed_count, 1);
    atomicMax(LIST.columns, columns_of(place + 1, rows));
    LIST.tiles[place].listed = i % counts.x | i / counts.x << 16;
#ifndef EDGES
    // The splats that were drawn before may have left it empty.
    covered.tiles[i].key = MARKED;
#endif
}

#endif
