// Resolve: each pixel takes what its nearest splat is, as if that were all that its sums held.
#version 450
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif

#include "lib/instance.glsl"
#include "lib/sums.glsl"
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"
#include "lib/surface.glsl"

#ifdef COMPUTE

#define WINNER_ACCESS readonly
#include "lib/winners.glsl"

layout(local_size_x = 64) in;

layout(set = 1, binding = 1, std430) writeonly buffer Sums0 { float sums0[]; };
layout(set = 1, binding = 2, std430) writeonly buffer Sums1 { float sums1[]; };

void store(uint pixel, float weight, float key, vec3 first, vec3 second) {
    sums0[WIDE_SUMS0 ? 4 * pixel : pixel] = weight;
    if (WIDE_SUMS0) for (uint k = 0; k < 3; k++) sums0[4 * pixel + 1 + k] = first[k];
    if (SUM_DEPTH) sums1[WIDE_SUMS1 ? 4 * pixel : pixel] = frame.key_gain * key;
    if (WIDE_SUMS1) for (uint k = 0; k < 3; k++) sums1[4 * pixel + 1 + k] = second[k];
}

void main() {
    uvec2 size = uvec2(frame.viewport);
    uint pixel = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (pixel >= size.x * size.y) return;
    uint64_t winner = winners[pixel];
    uint i = ~uint(winner & 0xffffffffu) - first_number();
    if (winner == 0) {
        if (first_number() == 0) store(pixel, 0.0, 0.0, vec3(0.0), vec3(0.0));
    } else if (i < window.count) {
        Splat splat = splat_of(i);
        vec3 first, second;
        surface_of(i, splat.epsilon, first, second);
        vec2 d = vec2(pixel % size.x, pixel / size.x) + 0.5 - anchor_of(splat);
        float key = plane_at(splat.plane_hi, splat.plane_lo, d);
        store(pixel, 1.0, has_linear_depth() ? view.near / key : key, first, second);
    }
}

#endif
