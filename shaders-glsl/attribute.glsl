// Attribute: weighted sums over the splats within ε of the nearest surface (zwicker2004 §6, second pass).
#version 450
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#extension GL_EXT_shader_atomic_float : require
#endif

#include "lib/frame.glsl"
#include "lib/sums.glsl"
#define SPLAT_ACCESS readonly
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"

#ifndef FRAGMENT

#include "lib/surface.glsl"

// What scales a splat's kernel.
float weight_of(uint i, Splat splat, vec2 variance) {
    return OVERLAP ? 1.0 : amplitude_of(splat, variance);
}

#endif
#ifdef COMPUTE

#include "lib/window.glsl"
#include "lib/pixels.glsl"

float splat_weight;
vec3 splat_first, splat_second;

vec2 scatter_variance(vec2 variance) {
    return attribute_variance(variance);
}

bool hidden(float nearest, ivec2 low, ivec2 high) {
    uint width = (uint(frame.viewport.x) + TILE - 1) / TILE;
    uvec2 first = uvec2(low) / TILE, last = uvec2(high) / TILE;
    uint farthest = 0xffffffffu;
    for (uint y = first.y; y <= last.y; y++)
        for (uint x = first.x; x <= last.x; x++) farthest = min(farthest, tiles[y * width + x]);
    return floatBitsToUint(max(nearest, 0.0)) < farthest;
}

bool scatter_begin(uint i, Splat splat, vec2 variance, float nearest, ivec2 low, ivec2 high) {
    if (!LARGE_SPLATS && hidden(nearest, low, high)) return false;
    splat_weight = weight_of(i, splat, variance);
    surface_of(i, splat.epsilon, splat_first, splat_second);
    return true;
}

void scatter(uint pixel, vec2 centre, float m2, float key, float rank) {
    uint nearest = visibility[pixel];
    // Where visibility wrote nothing there is no surface, whatever the wider attribute footprint says.
    if (nearest == 0u || floatBitsToUint(ranked(key, rank)) < nearest) return;
    float weight = OVERLAP ? 1.0 : splat_weight * kernel(m2);
    if (SUM_WEIGHTS) atomicAdd(sums0[WIDE_SUMS0 ? 4 * pixel : pixel], weight);
    if (WIDE_SUMS0) {
        atomicAdd(sums0[4 * pixel + 1], weight * splat_first.x);
        atomicAdd(sums0[4 * pixel + 2], weight * splat_first.y);
        atomicAdd(sums0[4 * pixel + 3], weight * splat_first.z);
    }
    if (SUM_DEPTH) atomicAdd(sums1[WIDE_SUMS1 ? 4 * pixel : pixel], weight * frame.key_gain * key);
    if (WIDE_SUMS1) {
        atomicAdd(sums1[4 * pixel + 1], weight * splat_second.x);
        atomicAdd(sums1[4 * pixel + 2], weight * splat_second.y);
        atomicAdd(sums1[4 * pixel + 3], weight * splat_second.z);
    }
}

#include "lib/scatter_splat.glsl"

void main() {
    scatter_splats();
}

#else
#include "lib/draw_splat.glsl"
#endif
#ifdef VERTEX

layout(location = 4) flat out float height;
layout(location = 5) flat out vec3 first;
layout(location = 6) flat out vec3 second;

void main() {
    uint i = gl_VertexIndex / 3;
    Splat splat = splats[i];
    vec2 variance = attribute_variance(splat.variance);
    place_splat(i, splat, variance, gl_VertexIndex % 3);
    height = weight_of(i, splat, variance);
    surface_of(i, splat.epsilon, first, second);
}

#endif
#ifdef FRAGMENT

layout(location = 4) flat in float height;
layout(location = 5) flat in vec3 first;
layout(location = 6) flat in vec3 second;

layout(location = 0) out vec4 sum0;
layout(location = 1) out vec4 sum1;

void main() {
    float m2, key, rank;
    drawn_fragment(m2, key, rank);
    float weight = OVERLAP ? 1.0 : height * kernel(m2);
    gl_FragDepth = ranked(key, rank);
    sum0 = weight * vec4(1.0, first);
    sum1 = weight * vec4(SUM_DEPTH ? frame.key_gain * key : 0.0, second);
}

#endif
