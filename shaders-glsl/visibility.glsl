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

#define VISIBILITY_ACCESS
#define VISIBILITY_STEPS 31000
#define COVERAGE_STEPS 31000
#include "lib/pixels.glsl"
#include "lib/tile.glsl"
#include "lib/tile_visibility.glsl"
#include "lib/tile_coverage.glsl"

layout(set = 1, binding = 5, std430) buffer Coverage { uint coverage[]; };

void main() {
    load_frame();
    uvec2 low = tile_low();
    for (uint r = 0; r < ROWS; r++) {
        uvec2 at = low + lane_pixel(r);
        uint pixel = is_on_picture(at) ? pixel_index(ivec2(at)) : 0;
        if (goes_on()) depths[r] = uintBitsToFloat(visibility[pixel]);
        if (goes_on() && COVERAGE) covered[r] = coverage[pixel];
    }
    find_visible(low);
    if (COVERAGE) find_covered(low);
    for (uint r = 0; r < ROWS; r++) {
        uvec2 at = low + lane_pixel(r);
        if (!is_on_picture(at)) continue;
        uint pixel = pixel_index(ivec2(at));
        visibility[pixel] = floatBitsToUint(depths[r]);
        if (COVERAGE) coverage[pixel] = covered[r];
    }
}

#else
#ifdef COVERAGE
#include "lib/coverage.glsl"
#endif
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
