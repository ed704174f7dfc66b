// Nearest: the nearest splat of each pixel, alone and whole: one pass, nothing is blended (zwicker2004 table 1; botsch2003 §3.2).
#version 450
#pragma variant COVERAGE VERTEX FRAGMENT
#pragma variant CLIP_LINES VERTEX FRAGMENT
#pragma variant SUBGROUPS COMPUTE
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

// What a dispatch leaves for the next, where there are several: the depth of each pixel, and the number of its splat.
#define VISIBILITY_ACCESS
#define SUMS_ACCESS
#include "lib/pixels.glsl"
layout(set = 1, binding = 5, std430) buffer Coverage { uint coverage[]; };

#define ALONE
#include "lib/tile.glsl"
#include "lib/tile_visibility.glsl"
#include "lib/tile_coverage.glsl"
#include "lib/attributes.glsl"

// The pixel at `at`, which shows splat `id` alone, as if that were all that its sums held.
Pixel pixel_of(uvec2 at, bool visible, uint id, float alpha) {
    Splat splat = splat_of(id);
    Attributes own = attributes_of(id);
    vec2 centre = vec2(at) + 0.5;
    float key = plane_at(splat.plane_hi, splat.plane_lo, centre - anchor_of(splat));
    if (has_linear_depth()) key = frame.near / key;
    return normalize_pixel(centre, visible, alpha, vec4(1.0, own.first), vec4(frame.key_gain * key, own.second));
}

void main() {
    load_frame();
    uvec2 low = tile_low();
    for (uint r = 0; r < ROWS; r++) {
        uvec2 at = low + lane_pixel(r);
        uint pixel = is_on_picture(at) ? pixel_index(ivec2(at)) : 0;
        if (goes_on()) depths[r] = uintBitsToFloat(visibility[pixel]);
        if (goes_on()) winners[r] = floatBitsToUint(sums0[pixel]);
        if (goes_on() && COVERAGE) covered[r] = coverage[pixel];
    }
    find_visible(low);
    if (COVERAGE) find_covered(low);
    for (uint r = 0; r < ROWS; r++) {
        uvec2 at = low + lane_pixel(r);
        if (!SLICED || !is_on_picture(at)) continue;
        uint pixel = pixel_index(ivec2(at));
        visibility[pixel] = floatBitsToUint(depths[r]);
        sums0[pixel] = uintBitsToFloat(winners[r]);
        if (COVERAGE) coverage[pixel] = covered[r];
    }
    if (!is_last()) return;
    for (uint r = 0; r < ROWS; r++) {
        uvec2 at = low + lane_pixel(r);
        float alpha = COVERAGE ? bitCount(covered[r]) / 16.0 : 1.0;
        Pixel pixel = pixel_of(at, depths[r] > 0.0, winners[r], alpha);
        if (is_on_picture(at)) store_pixel(at.y * uint(frame.viewport.x) + at.x, pixel);
    }
}

#else
#ifdef COVERAGE
#include "lib/coverage.glsl"
#endif
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
