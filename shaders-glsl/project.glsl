// Project: the nearest point of each pixel (marroquim2008 §3.1).
#version 450
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

layout(set = 0, binding = 2, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 3, std430) readonly buffer Normals { float normals[]; };
#include "lib/point.glsl"

layout(local_size_x = 64) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= window.count) return;
    ivec2 at;
    Sample s;
    if (!point_of(i, at, s)) return;
    uint64_t point = uint64_t(floatBitsToUint(s.near)) << 32 | uint64_t(window.first + i);
    atomicMin(nearest_points[uint(at.y) * uint(frame.viewport.x) + uint(at.x)], point);
}

#endif
