// Nearest: shows the nearest splat of each pixel without blending, in one pass (zwicker2004 table 1; botsch2003 §3.2).
#version 450
#pragma variant COVERAGE VERTEX FRAGMENT
#pragma variant CLIP_LINES VERTEX FRAGMENT
#pragma variant SUBGROUPS COMPUTE
#pragma variant SLICES COMPUTE
#pragma variant SUBGROUPS_SLICES COMPUTE
#extension GL_GOOGLE_include_directive : require
#include "lib/tile_pass.glsl"

#define VERTICES 3
#ifdef COMPUTE
#include "lib/frame.glsl"
#include "lib/picture_pixel.glsl"
#else
#include "lib/instance.glsl"
#include "lib/sums.glsl"
#endif
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"

#ifdef COMPUTE

#ifdef SLICES
#define VISIBILITY_STEPS 31000
#define COVERAGE_STEPS 31000
#define COVERAGE_UNROLLED 2
// State between the dispatches of a sliced frame: depth of each pixel, index of its splat, coverage.
#define VISIBILITY_ACCESS
#define SUMS_ACCESS
#include "lib/pixels.glsl"
layout(set = 1, binding = 5, std430) buffer Coverage { uint coverage[]; };
#endif

#define NEAREST_SPLAT
#include "lib/tile.glsl"
#include "lib/tile_visibility.glsl"
#include "lib/tile_coverage.glsl"
#include "lib/attributes.glsl"
#ifndef SLICES
#include "lib/covered_tiles.glsl"
#endif

// Output of a pixel that shows splat `id` only.
Pixel pixel_of(uvec2 coordinates, bool visible, uint id, float alpha) {
    Splat splat = splat_of(id);
    Attributes attributes = attributes_of(id);
    vec2 centre = vec2(coordinates) + 0.5;
    float key = plane_at(splat.plane_hi, splat.plane_lo, centre - anchor_of(splat));
    if (has_linear_depth()) key = world_key(key);
    return normalize_pixel(centre, visible, alpha, vec4(1.0, attributes.attribute0),
        vec4(frame.key_gain * shown_key(key, splat.key_disc), attributes.attribute1));
}

void main() {
    load_frame();
#ifndef SLICES
    uvec2 origin = LISTED_ORIGIN(covered);
#else
    uvec2 origin = tile_origin();
    for (uint r = 0; r < ROWS; r++) {
        uvec2 coordinates = origin + lane_pixel(r);
        uint pixel = is_in_viewport(coordinates) ? pixel_index(ivec2(coordinates)) : 0;
        if (is_resumed()) depths[r] = uintBitsToFloat(visibility[pixel]);
        if (is_resumed()) nearest_splats[r] = floatBitsToUint(sums0[pixel]);
        if (is_resumed() && COVERAGE) coverage_masks[r] = coverage[pixel];
    }
#endif
    compute_visibility(origin);
    if (COVERAGE) compute_coverage(origin);
    report_incomplete();
#ifdef SLICES
    for (uint r = 0; r < ROWS; r++) {
        uvec2 coordinates = origin + lane_pixel(r);
        if (!is_in_viewport(coordinates)) continue;
        uint pixel = pixel_index(ivec2(coordinates));
        visibility[pixel] = floatBitsToUint(depths[r]);
        sums0[pixel] = uintBitsToFloat(nearest_splats[r]);
        if (COVERAGE) coverage[pixel] = coverage_masks[r];
    }
    if (!is_last_slice()) return;
#endif
    FOR_ROWS(r) {
        uvec2 coordinates = origin + lane_pixel(r);
        float alpha = COVERAGE ? bitCount(coverage_masks[0]) / 16.0 : 1.0;
        Pixel pixel = pixel_of(coordinates, depths[0] > 0.0, nearest_splats[0], alpha);
        if (is_in_viewport(coordinates)) store_pixel(ivec2(coordinates), pixel);
        ROTATE(float, depths)
        ROTATE(uint, nearest_splats)
        if (COVERAGE) ROTATE(uint, coverage_masks)
    }
}

#else
#ifdef COVERAGE
#include "lib/coverage.glsl"
#endif
#include "lib/draw_splat.glsl"
#endif
#ifdef VERTEX

#include "lib/surfel_attributes.glsl"

layout(location = 4) flat out vec3 attribute0;
layout(location = 5) flat out vec3 attribute1;

void main() {
    uint i = surfel_index();
    Splat splat = splat_of(i);
    write_splat_vertex(i, splat, visibility_variance(variance_of(splat)), gl_VertexIndex % 3);
    surfel_attributes(i, splat.epsilon, attribute0, attribute1);
}

#endif
#ifdef FRAGMENT

layout(location = 4) flat in vec3 attribute0;
layout(location = 5) flat in vec3 attribute1;

layout(location = 0) out vec4 sum0;
layout(location = 1) out vec4 sum1;

void main() {
    vec2 m;
    float key, rank;
    evaluate_fragment(m, key, rank);
#ifdef COVERAGE
    add_fragment_coverage();
#endif
    gl_FragDepth = ranked(min(key, plane_lo_disc.w), rank);
    sum0 = vec4(1.0, attribute0);
    sum1 = vec4(SUM_DEPTH ? frame.key_gain * key : 0.0, attribute1);
}

#endif
