// Fetch: each pixel of level 0 takes what its nearest point is.
#version 450
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "lib/frame.glsl"
#include "lib/window.glsl"
#include "lib/sums.glsl"
#define SAMPLES_ONLY
#include "lib/pyramid.glsl"
#include "lib/lens.glsl"
#include "lib/nearest_points.glsl"
#include "lib/surface.glsl"
#include "lib/point.glsl"

layout(local_size_x = 64) in;

void main() {
    uvec2 size = uvec2(frame.viewport);
    uint pixel = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (pixel >= size.x * size.y) return;
    uint64_t point = nearest_points[pixel];
    uint i = uint(point & 0xffffffffu) - window.first;
    if (point == NO_POINT) {
        if (window.first == 0) store_pulled(pixel, NOTHING);
    } else if (i < window.count) {
        ivec2 at;
        Sample s;
        point_of(i, at, s);
        s.colour = colour_of(i);
        store_pulled(pixel, s);
    }
}

#endif
