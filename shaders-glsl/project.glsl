// Project: the nearest point of each pixel (marroquim2008 §3.1). A surfel is one point; segments (LINES) and TRIANGLES are several.
#version 450
#pragma variant LINES
#pragma variant TRIANGLES
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require

#include "lib/frame.glsl"
#include "lib/window.glsl"
#include "lib/sums.glsl"
#define SAMPLES_ONLY
#include "lib/pyramid.glsl"
#include "lib/lens.glsl"
#include "lib/nearest_points.glsl"

layout(local_size_x = 64) in;

// Number i of the window has a point in a pixel.
void project(uint i, ivec2 at, float nearest) {
    uint64_t point = uint64_t(floatBitsToUint(nearest)) << 32 | uint64_t(window.first + i);
    atomicMin(nearest_points[uint(at.y) * uint(frame.viewport.x) + uint(at.x)], point);
}

#if defined(LINES)

#include "lib/primitives.glsl"
#include "lib/line.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    Segment segment;
    if (i >= window.count || !segment_of(i, segment)) return;
    for (int k = 0; k < segment.strands; k++) {
        Strand strand;
        if (!strand_of(segment, k, strand)) continue;
        ivec2 columns = columns_of(strand);
        for (int column = columns.x; column <= columns.y; column++) {
            Place place;
            if (place_of(segment, strand, column, place)) project(i, place.at, place.nearest);
        }
    }
}

#elif defined(TRIANGLES)

#include "lib/primitives.glsl"
#include "lib/triangle.glsl"

// Triangles of more pixels than an invocation should visit, which are left to a second dispatch with a workgroup a triangle.
layout(constant_id = 30) const bool LARGE_TRIANGLES = false;
const uint MOST = 64; // pixels of the box about one that is not large
layout(set = 3, binding = 4, std430) buffer Large { uint large_count; uint large[]; };

void project_box(uint i, Triangle triangle, ivec4 box, uint first, uint step) {
    uint width = uint(box.z - box.x + 1), area = width * uint(box.w - box.y + 1);
    for (uint k = first; k < area; k += step) {
        ivec2 at = box.xy + ivec2(k % width, k / width);
        vec3 weights;
        float distance;
        if (weights_at(triangle, at, weights, distance)) project(i, at, distance);
    }
}

void main() {
    Triangle triangle;
    if (LARGE_TRIANGLES) {
        for (uint k = gl_WorkGroupID.x; k < large_count; k += gl_NumWorkGroups.x) {
            triangle_of(large[k], triangle);
            project_box(large[k], triangle, box_of(triangle), gl_LocalInvocationIndex, gl_WorkGroupSize.x);
        }
        return;
    }
    uint i = gl_GlobalInvocationID.x;
    if (i >= window.count || !triangle_of(i, triangle)) return;
    ivec4 box = box_of(triangle);
    if (any(greaterThan(box.xy, box.zw))) return;
    ivec2 size = box.zw - box.xy + 1;
    if (uint(size.x) * uint(size.y) > MOST) large[atomicAdd(large_count, 1)] = i;
    else project_box(i, triangle, box, 0, 1);
}

#else

layout(set = 0, binding = 2, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 3, std430) readonly buffer Normals { float normals[]; };
#include "lib/point.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    ivec2 at;
    Sample s;
    if (i < window.count && point_of(i, at, s)) project(i, at, s.near);
}

#endif
#endif
