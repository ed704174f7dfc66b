// Tiles: the farthest visible surface of each tile, so that the attribute pass skips splats that are hidden whole.
#version 450
#extension GL_GOOGLE_include_directive : require

#include "lib/frame.glsl"
#define TILES_ACCESS writeonly
#include "lib/pixels.glsl"

#ifdef COMPUTE

layout(local_size_x = 64) in;

void main() {
    uvec2 size = uvec2(frame.viewport);
    uvec2 tiling = (size + TILE - 1) / TILE;
    uint i = gl_GlobalInvocationID.x;
    if (i >= tiling.x * tiling.y) return;
    uvec2 low = TILE * uvec2(i % tiling.x, i / tiling.x);
    uvec2 high = min(low + TILE, size);
    uint farthest = 0xffffffffu;
    for (uint y = low.y; y < high.y; y++) {
        for (uint x = low.x; x < high.x; x++) {
            uint key = visibility[y * size.x + x];
            // Empty pixels take no attributes, so they hide nothing and let nothing through.
            if (key != 0u) farthest = min(farthest, key);
        }
    }
    tiles[i] = farthest;
}

#endif
