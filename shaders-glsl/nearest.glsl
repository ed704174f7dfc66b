// Nearest: the nearest splat of each pixel, alone and whole: one pass, nothing is blended (zwicker2004 table 1; botsch2003 §3.2).
#version 450
#pragma variant COVERAGE
#pragma variant CLIP_LINES VERTEX FRAGMENT
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif

#define VERTICES 3
#include "lib/instance.glsl"
#include "lib/sums.glsl"
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"
#ifdef COVERAGE
#include "lib/coverage.glsl"
#endif

#ifdef COMPUTE

#define WINNER_ACCESS
#include "lib/winners.glsl"

uint splat_index;
float splat_key_disc;
#ifdef COVERAGE
Ellipse splat_solid;
#endif

vec2 scatter_variance(vec2 variance) {
    return visibility_variance(variance);
}

bool scatter_begin(uint i, Splat splat, vec2 variance, float nearest, ivec2 low, ivec2 high) {
    splat_index = i;
    splat_key_disc = splat.key_disc;
#ifdef COVERAGE
    splat_solid = solid_of(splat, screen_clip_number(i));
#endif
    return true;
}

void scatter(uint pixel, vec2 centre, vec2 m, float key, float rank) {
#ifdef COVERAGE
    cover(pixel, splat_solid, centre);
#endif
    atomicMax(winners[pixel], winner(ranked(min(key, splat_key_disc), rank), splat_index));
}

#include "lib/scatter_splat.glsl"

void main() {
    scatter_splats();
}

#else
#include "lib/draw_splat.glsl"
#endif
#ifdef VERTEX

#include "lib/surface.glsl"

layout(location = 4) flat out vec3 first;
layout(location = 5) flat out vec3 second;

void main() {
    uint i = surfel_number();
    Splat splat = splat_of(i);
    place_splat(i, splat, visibility_variance(variance_of(splat)), gl_VertexIndex % 3);
    surface_of(i, splat.epsilon, first, second);
}

#endif
#ifdef FRAGMENT

layout(location = 4) flat in vec3 first;
layout(location = 5) flat in vec3 second;

layout(location = 0) out vec4 sum0;
layout(location = 1) out vec4 sum1;

void main() {
    vec2 m;
    float key, rank;
    drawn_fragment(m, key, rank);
    gl_FragDepth = ranked(min(key, plane_lo_disc.w), rank);
    sum0 = vec4(1.0, first);
    sum1 = vec4(SUM_DEPTH ? frame.key_gain * key : 0.0, second);
}

#endif
