// Visibility: the depth of the nearest surface, moved back by ε along the viewing rays (zwicker2004 §6, first pass).
#version 450
#pragma variant COVERAGE
#pragma variant CLIP_LINES VERTEX FRAGMENT
#extension GL_GOOGLE_include_directive : require

#define VERTICES 3
#include "lib/instance.glsl"
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"
#ifdef COVERAGE
#include "lib/coverage.glsl"
#endif

#ifdef COMPUTE

#define VISIBILITY_ACCESS
#include "lib/pixels.glsl"

float splat_epsilon, splat_key_disc;
#ifdef COVERAGE
Ellipse splat_solid;
#endif

vec2 scatter_variance(vec2 variance) {
    return visibility_variance(variance);
}

bool scatter_begin(uint i, Splat splat, vec2 variance, float nearest, ivec2 low, ivec2 high) {
    splat_epsilon = splat.epsilon;
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
    float moved = visibility_key(key, splat_key_disc, splat_epsilon);
    atomicMax(visibility[pixel], floatBitsToUint(ranked(moved, rank)));
}

#include "lib/scatter_splat.glsl"

void main() {
    scatter_splats();
}

#else
#include "lib/draw_splat.glsl"
#endif
#ifdef VERTEX

void main() {
    uint i = surfel_number();
    Splat splat = splat_of(i);
    place_splat(i, splat, visibility_variance(variance_of(splat)), gl_VertexIndex % 3);
}

#endif
#ifdef FRAGMENT

void main() {
    vec2 m;
    float key, rank;
    drawn_fragment(m, key, rank);
    gl_FragDepth = ranked(visibility_key(key, plane_lo_disc.w, plane_epsilon.w), rank);
}

#endif
