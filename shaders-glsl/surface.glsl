// Surface: runs visibility, attribute and normalize per tile in one dispatch, without intermediate targets (zwicker2004 §6). Frames that
// cull some splats that face away first draw those that face the eye, then once more in the tiles that revealed clusters may change; the last
// dispatch draws open tiles again. MIXED: pass behind follows.
#version 450
#pragma variant SUBGROUPS COMPUTE
#extension GL_GOOGLE_include_directive : require
#include "lib/tile_pass.glsl"

#ifdef COMPUTE

#define FRONT_TILES
#define VISIBILITY_ACCESS
#include "lib/frame.glsl"
#include "lib/picture_pixel.glsl"
#include "lib/splat.glsl"
#include "lib/pixels.glsl"
#include "lib/tile.glsl"
#include "lib/tile_visibility.glsl"
#include "lib/tile_coverage.glsl"
#include "lib/tile_attribute.glsl"
#include "lib/covered_tiles.glsl"
#include "lib/open_tiles.glsl"
#include "lib/edge_tiles.glsl"
#include "lib/revealed_tiles.glsl"

layout(set = 1, binding = 5, std430) buffer Coverage { uint coverage[]; };

void load_depths(uvec2 origin) {
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        load_depth(r, visibility[is_in_viewport(pixel) ? pixel_index(ivec2(pixel)) : 0]);
    }
}

void store_depths(uvec2 origin) {
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        if (is_in_viewport(pixel)) visibility[pixel_index(ivec2(pixel))] = depth_bits(r);
    }
}

// Stores the samples of each pixel, those of the nearest surface in the upper bits, and whether others show the surface behind.
void store_edges(uvec2 origin) {
    bool has_edges = false;
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        if (!is_in_viewport(pixel)) continue;
        coverage[pixel_index(ivec2(pixel))] = coverage_masks[r] | nearest_masks[r] << SAMPLES;
        has_edges = has_edges || coverage_masks[r] != nearest_masks[r];
    }
    uint with_edges = workgroup_ballot(has_edges);
    if (lane == 0 && is_in_viewport(origin)) edges.tiles[tile_index(origin / TILE)].key = with_edges != 0 ? MARKED : 0;
}

// Stores the κ behind which splats do not change the tile: 0 if it has empty pixels, or uncovered samples, which hidden splats cover, too.
void store_key(uvec2 origin) {
    bool is_covered = !COVERAGE || incomplete_pixels == uvec2(0);
    if (lane == 0 && is_in_viewport(origin)) open.tiles[tile_index(origin / TILE)].key = is_covered ? floatBitsToUint(visibility_cull_key) : 0;
}

// First pixel of the workgroup's tile.
uvec2 origin_of_workgroup() {
    if (has_fronts()) return LISTED_ORIGIN(open);
    return is_of_revealed() ? LISTED_ORIGIN(revealed) : LISTED_ORIGIN(covered);
}

void main() {
    load_frame();
    uvec2 origin = origin_of_workgroup();
    if (has_depths()) load_depths(origin);
    compute_visibility(origin);
    if (MIXED || is_of_fronts()) store_depths(origin);
    if (COVERAGE) compute_coverage(origin);
    if (is_of_fronts()) store_key(origin);
    if (MIXED) store_edges(origin);
    sum_attributes(origin);
    report_incomplete();
    FOR_ROWS(r) {
        uvec2 pixel = origin + lane_pixel(r);
        float alpha = COVERAGE ? bitCount(coverage_masks[0]) / 16.0 : 1.0;
        Pixel result = normalize_pixel(vec2(pixel) + 0.5, depths[0] > 0.0, alpha, tile_sums0[0], tile_sums1[0]);
        if (is_in_viewport(pixel)) store_pixel(ivec2(pixel), result);
        ROTATE(float, depths)
        ROTATE(vec4, tile_sums0)
        ROTATE(vec4, tile_sums1)
        if (COVERAGE) ROTATE(uint, coverage_masks)
    }
}

#endif
