// Occupied: lists the pyramid tiles that have a nearest point, for dispatches over these. With RASTER_POINTS the points come from the raster
// path.
#version 450
#pragma variant RASTER_POINTS
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#ifdef RASTER_POINTS
#extension GL_EXT_samplerless_texture_functions : require
#else
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif

#include "lib/frame.glsl"
#ifdef RASTER_POINTS
#include "lib/raster_points.glsl"
#else
#define NEAREST_ACCESS readonly
#include "lib/nearest_points.glsl"
#endif
#define OCCUPIED_ACCESS
#include "lib/occupied_tiles.glsl"

// An invocation per row of pixels of a tile.
layout(local_size_x = 64) in;

// Whether the rows of the workgroup's tiles have a point.
shared bool occupied_rows[gl_WorkGroupSize.x];

bool has_point(uvec2 pixel) {
#ifdef RASTER_POINTS
    uint id;
    float distance;
    return raster_point(ivec2(pixel), id, distance);
#else
    return nearest_points[pixel.y * uint(frame.viewport.x) + pixel.x] != NO_POINT;
#endif
}

// Whether a row of a tile, from this pixel on, has a point.
bool is_occupied(uvec2 first) {
    uvec2 size = uvec2(frame.viewport);
    if (first.y >= size.y) return false;
    bool found = false;
    uint end = min(first.x + TILE, size.x);
    for (uint x = first.x; x < end && !found; x++) found = has_point(uvec2(x, first.y));
    return found;
}

void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i == 0) BEGIN_LIST(occupied)
    uint index = i / TILE, row = i % TILE, columns = tile_counts().x;
    uvec2 tile = uvec2(index % columns, index / columns);
    occupied_rows[gl_LocalInvocationIndex] = is_occupied(TILE * tile + uvec2(0, row));
    barrier();
    if (row != 0 || tile.y >= tile_counts().y) return;
    bool found = false;
    for (uint k = 0; k < TILE; k++) found = found || occupied_rows[gl_LocalInvocationIndex + k];
    occupied.tiles[index].key = found ? MARKED : 0;
    if (found) LIST_TILE(occupied, tile)
}

#endif
