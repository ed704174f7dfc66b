// Attribute: weighted sums over the splats within ε of the nearest surface (zwicker2004 §6, second pass).
#version 450
#pragma variant CLIP_LINES VERTEX FRAGMENT
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#extension GL_EXT_shader_atomic_float : require
#endif

#define VERTICES 3
#include "lib/instance.glsl"
#include "lib/sums.glsl"
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"
#include "lib/weights.glsl"

#ifndef FRAGMENT

#include "lib/surface.glsl"

// What scales a splat's kernel everywhere, and what scales it further at the corners of the surfel's square.
float weight_of(uint i, Splat splat, vec2 variance, out vec4 corners, out mat2 square) {
    corners = vec4(1.0);
    square = mat2(1.0);
    if (OVERLAP) return 1.0;
    float amplitude = amplitude_of(splat, variance);
    uint weight = WEIGHTS ? weights[i] : floatBitsToUint(1.0);
    if (!CORNERS || (weight & AT_CORNERS) == 0) return amplitude * uintBitsToFloat(weight);
    float at[8];
    for (uint k = 0; k < 8; k++) at[k] = uintBitsToFloat(weights[(weight & ~AT_CORNERS) + k]);
    corners = vec4(at[0], at[1], at[2], at[3]);
    vec3 to_eye = view.eye_hi.xyz - position_of(i) + view.eye_lo.xyz;
    square = square_of(splat, vec3(at[4], at[5], at[6]), at[7], normal_of(i), to_eye);
    return amplitude;
}

#endif
#ifdef COMPUTE

#define SUMS_ACCESS
#include "lib/pixels.glsl"

float splat_weight;
vec4 splat_corners;
mat2 splat_square;
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
    splat_weight = weight_of(i, splat, variance, splat_corners, splat_square);
    surface_of(i, splat.epsilon, splat_first, splat_second);
    return true;
}

void scatter(uint pixel, vec2 centre, vec2 m, float key, float rank) {
    uint nearest = visibility[pixel];
    // Where visibility wrote nothing there is no surface, whatever the wider attribute footprint says.
    if (nearest == 0u || floatBitsToUint(ranked(key, rank)) < nearest) return;
    float weight = OVERLAP ? 1.0 : splat_weight * kernel(dot(m, m));
    if (CORNERS && !OVERLAP) weight *= weight_in(splat_corners, splat_square, m);
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
layout(location = 7) flat out vec4 corners;
layout(location = 8) flat out vec4 square;

void main() {
    uint i = surfel_number();
    Splat splat = splat_of(i);
    vec2 variance = attribute_variance(variance_of(splat));
    place_splat(i, splat, variance, gl_VertexIndex % 3);
    mat2 axes;
    height = weight_of(i, splat, variance, corners, axes);
    square = vec4(axes[0], axes[1]);
    surface_of(i, splat.epsilon, first, second);
}

#endif
#ifdef FRAGMENT

layout(location = 4) flat in float height;
layout(location = 5) flat in vec3 first;
layout(location = 6) flat in vec3 second;
layout(location = 7) flat in vec4 corners;
layout(location = 8) flat in vec4 square;

layout(location = 0) out vec4 sum0;
layout(location = 1) out vec4 sum1;

void main() {
    vec2 m;
    float key, rank;
    drawn_fragment(m, key, rank);
    float weight = OVERLAP ? 1.0 : height * kernel(dot(m, m));
    if (CORNERS && !OVERLAP) weight *= weight_in(corners, mat2(square.xy, square.zw), m);
    gl_FragDepth = ranked(key, rank);
    sum0 = weight * vec4(1.0, first);
    sum1 = weight * vec4(SUM_DEPTH ? frame.key_gain * key : 0.0, second);
}

#endif
