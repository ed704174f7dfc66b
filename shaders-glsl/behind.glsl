// Behind: mixes the surface behind into pixels at edges, whose nearest surface leaves some of the covered samples to other splats. The nearest of
// these, and what is within its ε, shows in all of them.
#version 450
#pragma variant SUBGROUPS COMPUTE
#pragma variant SLICES COMPUTE
#pragma variant SUBGROUPS_SLICES COMPUTE
#pragma variant MIX COMPUTE
#pragma variant NEAREST_SAMPLES FRAGMENT
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/tile_pass.glsl"

#if defined(COMPUTE) && !defined(MIX)

#define BEHIND
#define COVERAGE_KNOWN true
#ifdef SLICES
#define COVERAGE_STEPS 62000
#define COVERAGE_UNROLLED 2
#define BEHIND_STEPS 62000
#define ATTRIBUTE_STEPS 62000
#define SUMS_ACCESS
#define STORES_SUMS
#define COVERAGE_ACCESS
#else
#define COVERAGE_ACCESS readonly
#define COVERAGE_STEPS 12000
#define BEHIND_STEPS 24000
#define ATTRIBUTE_STEPS 26000
#endif
#include "lib/frame.glsl"
#define IMAGE_ACCESS
#include "lib/picture_pixel.glsl"
#include "lib/splat.glsl"
#include "lib/pixels.glsl"
#include "lib/tile.glsl"

layout(set = 1, binding = 5, std430) COVERAGE_ACCESS buffer Coverage { uint coverage[]; };

float nearest_depths[ROWS]; // of the nearest surface, where `depths` are of the surface behind
uint full_pixels = 0;

#include "lib/tile_coverage.glsl"
#include "lib/tile_behind.glsl"
#include "lib/tile_attribute.glsl"
#include "lib/mix_behind.glsl"
#ifdef SLICES
#include "lib/stored_sums.glsl"
#endif

void load_pixels(uvec2 origin) {
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        uint index = is_in_viewport(pixel) ? pixel_index(ivec2(pixel)) : 0;
        uint samples = is_in_viewport(pixel) ? coverage[index] : 0;
        depths[r] = is_in_viewport(pixel) ? uintBitsToFloat(visibility[index] & ~FULL_PIXEL) : 0.0;
        coverage_masks[r] = samples & ALL_SAMPLES;
        nearest_masks[r] = samples >> SAMPLES;
    }
}

// Finds the samples of the nearest surface.
void find_nearest_samples(uvec2 origin) {
    visited_count = MOST_VISITED + 1;
    compute_coverage(origin);
}

// Sets the free samples of rows from the masks of pixels.
void find_free_samples() {
    uint masks[ROWS], row_masks[TILE];
    for (uint r = 0; r < ROWS; r++) masks[r] = coverage_masks[r] & ~nearest_masks[r];
    GATHER_ROW(uint, masks, row_masks)
    uint columns = 0;
    for (uint w = 0; w < SAMPLE_WORDS; w++) row_free[w] = 0;
    for (uint x = 0; x < TILE; x++) {
        columns |= uint(row_masks[x] != 0) << x;
        for (uint j = 0; j < LANE_SAMPLES; j++) {
            row_free[j / 4] |= (row_masks[x] >> lane / TILE * LANE_SAMPLES + j & 1u) << 8 * (j % 4) + x;
        }
    }
    incomplete_pixels = pixels_of_rows(columns);
}

void mix_pixels(uvec2 origin) {
    FOR_ROWS(r) {
        ivec2 pixel = ivec2(origin + lane_pixel(r));
        if (depths[0] > 0.0) mix_behind(pixel, coverage_masks[0], nearest_masks[0], tile_sums0[0], tile_sums1[0]);
        ROTATE(float, depths)
        ROTATE(uint, coverage_masks)
        ROTATE(uint, nearest_masks)
        ROTATE(vec4, tile_sums0)
        ROTATE(vec4, tile_sums1)
    }
}

#ifndef SLICES

#include "lib/edge_tiles.glsl"

// The passes of surface run separately: the samples of the nearest surface are not known yet, nor the tiles with edges.
layout(constant_id = 81) const bool SPLIT = false;

void main() {
    load_frame();
    uvec2 origin = SPLIT ? tile_origin() : LISTED_ORIGIN(edges);
    load_pixels(origin);
    if (SPLIT) find_nearest_samples(origin);
    else GATHER_ROW(float, depths, row_depths)
    find_free_samples();
    for (uint x = 0; x < TILE; x++) row_behind[x] = 0.0;
    compute_behind(origin);
    sum_attributes(origin);
    report_incomplete();
    mix_pixels(origin);
}

#else

// Stages of a frame in slices; each visits all slices before the next begins.
layout(constant_id = 74) const uint STAGE = 0;
const uint NEAREST_SAMPLES = 0, DEPTHS = 1, ATTRIBUTES = 2;

// Bits of the κ of the surface behind, moved back by ε; 0 where there is none.
layout(set = 1, binding = 24, std430) buffer BehindDepths { uint behind_depths[]; };

// Adds the slice's samples of the nearest surface to those of the pixels.
void add_nearest_samples(uvec2 origin) {
    find_nearest_samples(origin);
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        if (is_in_viewport(pixel)) coverage[pixel_index(ivec2(pixel))] |= nearest_masks[r] << SAMPLES;
    }
}

// Updates the depths of the surface behind with the slice's splats.
void update_depths(uvec2 origin) {
    GATHER_ROW(float, depths, row_depths)
    find_free_samples();
    for (uint x = 0; x < TILE; x++) {
        uvec2 pixel = origin + uvec2(x, lane % TILE);
        uint index = is_in_viewport(pixel) ? pixel_index(ivec2(pixel)) : 0;
        row_behind[x] = is_resumed() ? uintBitsToFloat(behind_depths[index]) : 0.0;
    }
    compute_behind(origin);
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        if (is_in_viewport(pixel)) behind_depths[pixel_index(ivec2(pixel))] = floatBitsToUint(depths[r]);
    }
}

// Adds the slice's splats to the sums of the surface behind; mixes it into the picture after the last one.
void add_slice_attributes(uvec2 origin) {
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        uint index = is_in_viewport(pixel) ? pixel_index(ivec2(pixel)) : 0;
        nearest_depths[r] = depths[r];
        depths[r] = uintBitsToFloat(behind_depths[index]);
        if (is_resumed()) load_sums(index, tile_sums0[r], tile_sums1[r]);
    }
    visited_count = MOST_VISITED + 1;
    sum_attributes(origin);
    if (is_last_slice()) {
        mix_pixels(origin);
        return;
    }
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        if (is_in_viewport(pixel)) store_sums(pixel_index(ivec2(pixel)), tile_sums0[r], tile_sums1[r]);
    }
}

void main() {
    load_frame();
    uvec2 origin = tile_origin();
    load_pixels(origin);
    if (STAGE == NEAREST_SAMPLES) add_nearest_samples(origin);
    if (STAGE == DEPTHS) update_depths(origin);
    if (STAGE == ATTRIBUTES) add_slice_attributes(origin);
    report_incomplete();
}

#endif
#endif

#ifndef COMPUTE

// On the raster path: first the samples of the nearest surface, then the depths of the surface behind, its sums by pass attribute, and MIX.

#define COVERAGE
#define VERTICES 3
#include "lib/instance.glsl"
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"
#include "lib/coverage.glsl"
#include "lib/draw_splat.glsl"

#endif
#ifdef VERTEX

void main() {
    uint i = surfel_index();
    Splat splat = splat_of(i);
    write_splat_vertex(i, splat, visibility_variance(variance_of(splat)), gl_VertexIndex % 3);
}

#endif
#ifdef FRAGMENT

layout(set = 1, binding = 9) uniform texture2D visibility_image;

void main() {
    vec2 m;
    float key, rank;
    evaluate_fragment(m, key, rank);
    float nearest_depth = texelFetch(visibility_image, ivec2(gl_FragCoord.xy), 0).r;
    bool is_behind = ranked(key, rank) < nearest_depth;
    uint samples = coverage[fragment_index()];
#ifdef NEAREST_SAMPLES
    if (!is_behind) atomicOr(coverage[fragment_index()], fragment_mask() << SAMPLES);
    discard;
#else
    uint free = samples & ALL_SAMPLES & ~(samples >> SAMPLES);
    if (!is_behind || (fragment_mask() & free) == 0) discard;
    gl_FragDepth = ranked(visibility_key(key, plane_lo_disc.w, plane_epsilon.w), rank);
#endif
}

#endif
#if defined(COMPUTE) && defined(MIX)

#define IMAGE_ACCESS
#include "lib/frame.glsl"
#include "lib/picture_pixel.glsl"
#include "lib/pixel_group.glsl"
#include "lib/lattice.glsl"
#include "lib/mix_behind.glsl"

layout(set = 1, binding = 5, std430) readonly buffer Coverage { uint coverage[]; };
layout(set = 1, binding = 10) uniform texture2D sums0_image;
layout(set = 1, binding = 11) uniform texture2D sums1_image;
layout(set = 1, binding = 26) uniform texture2D behind_image;

void main() {
    load_frame();
    ivec2 pixel = invocation_pixel(), size = picture_size();
    if (any(greaterThanEqual(pixel, size)) || texelFetch(behind_image, pixel, 0).r == 0.0) return;
    uint samples = coverage[pixel.y * size.x + pixel.x];
    vec4 s1 = SUM_DEPTH || WIDE_SUMS1 ? texelFetch(sums1_image, pixel, 0) : vec4(0.0);
    mix_behind(pixel, samples & ALL_SAMPLES, samples >> SAMPLES, texelFetch(sums0_image, pixel, 0), s1);
}

#endif
