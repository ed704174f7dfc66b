// Visibility: the depth of the nearest surface, moved back by ε along the viewing rays (zwicker2004 §6, first pass).
#version 450
#pragma variant COVERAGE VERTEX FRAGMENT
#pragma variant CLIP_LINES VERTEX FRAGMENT
#pragma variant SUBGROUPS COMPUTE
#extension GL_GOOGLE_include_directive : require
#include "lib/tile_pass.glsl"

#define VERTICES 3
#ifdef COMPUTE
#include "lib/frame.glsl"
#else
#include "lib/instance.glsl"
#endif
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"

#ifdef COMPUTE

#define FRONT_TILES
#define VISIBILITY_ACCESS
#define VISIBILITY_STEPS 31000
#define COVERAGE_STEPS 31000
#define COVERAGE_UNROLLED 2
#include "lib/pixels.glsl"
#include "lib/tile.glsl"
#include "lib/tile_visibility.glsl"
#include "lib/tile_coverage.glsl"

layout(set = 1, binding = 5, std430) buffer Coverage { uint coverage[]; };

void main() {
    load_frame();
    uvec2 origin = tile_origin();
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        uint index = is_in_viewport(pixel) ? pixel_index(ivec2(pixel)) : 0;
        if (has_depths()) load_depth(r, visibility[index]);
        if (is_resumed() && COVERAGE && !is_of_fronts()) coverage_masks[r] = coverage[index];
    }
    compute_visibility(origin);
    if (COVERAGE && !is_of_fronts()) compute_coverage(origin);
    report_incomplete();
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        if (!is_in_viewport(pixel)) continue;
        uint index = pixel_index(ivec2(pixel));
        visibility[index] = depth_bits(r);
        if (COVERAGE && !is_of_fronts()) coverage[index] = coverage_masks[r];
    }
}

#else
#ifdef COVERAGE
#include "lib/coverage.glsl"
#endif
#include "lib/draw_splat.glsl"
#endif
#ifdef VERTEX

layout(constant_id = 69) const bool FRONTS = false; // only splats that face the eye: the pass before sides

void main() {
    uint i = surfel_index();
    Splat splat = splat_of(i);
    if (FRONTS && is_back(splat)) splat.anchor = 0;
    write_splat_vertex(i, splat, visibility_variance(variance_of(splat)), gl_VertexIndex % 3);
}

#endif
#ifdef FRAGMENT

void main() {
    vec2 m;
    float key, rank;
    evaluate_fragment(m, key, rank);
#ifdef COVERAGE
    add_fragment_coverage();
#endif
    gl_FragDepth = ranked(visibility_key(key, plane_lo_disc.w, plane_epsilon.w), rank);
}

#endif
