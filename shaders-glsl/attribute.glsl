// Attribute: weighted sums over the splats within ε of the nearest surface (zwicker2004 §6, second pass).
#version 450
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#extension GL_EXT_shader_atomic_float : require
#endif

#include "lib/frame.glsl"
#include "lib/sums.glsl"
#define SPLAT_ACCESS readonly
#include "lib/splat.glsl"

#ifndef FRAGMENT

layout(set = 0, binding = 3, std430) readonly buffer Normals { float normals[]; };
layout(set = 0, binding = 5, std430) readonly buffer Colours { uint colours[]; };

vec3 srgb_to_linear(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec3 colour_of(uint i) {
    if (COLOURS == COLOURS_LINEAR)
        return uintBitsToFloat(uvec3(colours[3 * i], colours[3 * i + 1], colours[3 * i + 2]));
    return srgb_to_linear(unpackUnorm4x8(colours[i]).rgb);
}

// What the two targets sum of surfel i, see lib/sums.glsl.
void attributes_of(uint i, float epsilon, out vec3 first, out vec3 second) {
    second = COLOURS != COLOURS_NONE ? colour_of(i) : vec3(0.0);
    first = second;
    if (SUM_NORMALS) first = sign(epsilon) * vec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
}

#endif
#ifdef COMPUTE

#include "lib/pixels.glsl"

float splat_amplitude;
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
    splat_amplitude = amplitude_of(splat, variance);
    attributes_of(i, splat.epsilon, splat_first, splat_second);
    return true;
}

void scatter(uint pixel, float m2, float key) {
    uint nearest = visibility[pixel];
    // Where visibility wrote nothing there is no surface, whatever the wider attribute footprint says.
    if (nearest == 0u || floatBitsToUint(key) < nearest) return;
    float weight = splat_amplitude * exp(-0.5 * m2);
    if (SUM_NORMALS || COLOURS != COLOURS_NONE) {
        atomicAdd(sums0[4 * pixel], weight);
        atomicAdd(sums0[4 * pixel + 1], weight * splat_first.x);
        atomicAdd(sums0[4 * pixel + 2], weight * splat_first.y);
        atomicAdd(sums0[4 * pixel + 3], weight * splat_first.z);
    } else {
        atomicAdd(sums0[pixel], weight);
    }
    if (SUM_NORMALS && COLOURS != COLOURS_NONE) {
        if (SUM_DEPTH) atomicAdd(sums1[4 * pixel], weight * frame.key_gain * key);
        atomicAdd(sums1[4 * pixel + 1], weight * splat_second.x);
        atomicAdd(sums1[4 * pixel + 2], weight * splat_second.y);
        atomicAdd(sums1[4 * pixel + 3], weight * splat_second.z);
    } else if (SUM_DEPTH) {
        atomicAdd(sums1[pixel], weight * frame.key_gain * key);
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

layout(location = 4) flat out float amplitude;
layout(location = 5) flat out vec3 first;
layout(location = 6) flat out vec3 second;

void main() {
    uint i = gl_VertexIndex / 3;
    Splat splat = splats[i];
    amplitude = place_splat(splat, attribute_variance(splat.variance), gl_VertexIndex % 3);
    attributes_of(i, splat.epsilon, first, second);
}

#endif
#ifdef FRAGMENT

layout(location = 4) flat in float amplitude;
layout(location = 5) flat in vec3 first;
layout(location = 6) flat in vec3 second;

layout(location = 0) out vec4 sum0;
layout(location = 1) out vec4 sum1;

void main() {
    float m2, key;
    drawn_fragment(m2, key);
    float weight = amplitude * exp(-0.5 * m2);
    gl_FragDepth = key;
    sum0 = weight * vec4(1.0, first);
    sum1 = weight * vec4(SUM_DEPTH ? frame.key_gain * key : 0.0, second);
}

#endif
