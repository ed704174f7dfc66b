// Coverage on a tile: masks of the 16 samples of each pixel that lie on a surface: see lib/coverage.glsl.

#include "lib/coverage.glsl"

layout(constant_id = 31) const bool COVERAGE = false; // α is the covered part of a pixel

uint coverage_masks[ROWS];

// As UNROLLED: 2 is slower than 1 but takes half the iterations.
#ifndef COVERAGE_UNROLLED
#define COVERAGE_UNROLLED 1
#endif

// κ below which splats are skipped: 0 while samples of visible pixels are uncovered.
float coverage_cull_key;

void update_coverage_cull_key() {
    uint all_masks = ALL_SAMPLES;
    for (uint r = 0; r < ROWS; r++) all_masks &= depths[r] > 0.0 ? coverage_masks[r] : ALL_SAMPLES;
    coverage_cull_key = workgroup_min(all_masks == ALL_SAMPLES ? 2.0 : 0.0) > 1.0 ? 1e30 : 0.0;
}

// Mask of the samples that a splat covers at d px from the tile's first pixel, where it has a fragment: see coverage_mask. `solid` is its
// solid ellipse.
uint mask_on_tile(TileSplat solid, vec2 offset, vec2 d) {
    float limit = SOLID * frame.cutoff;
    float nearness = on_plane() ? value_at(solid.plane, d) / solid.key_centre : 1.0;
    vec2 slope = on_plane() ? (solid.plane.grid.yz + solid.plane.rest.yz) / solid.key_centre : vec2(0.0);
    vec2 centre = value_at(solid.kernel, d);
    uint mask = 0;
    for (uint k = 0; k < SAMPLES; k++) {
        vec2 s = sample_position(k);
        vec2 u = centre + vec2(dot(solid.kernel.u.yz, s), dot(solid.kernel.v.yz, s));
        if (on_plane()) u /= clamp(nearness + dot(slope, s), 1.0 / MOST_STRETCH, MOST_STRETCH);
        bool inside = rim() > 1.0 ? max(abs(u.x), abs(u.y)) <= limit : dot(u, u) <= limit * limit;
        if (CLIPS) inside = inside && clip_distance(solid, d + s) >= -SEAM;
        mask |= uint(inside) << k;
    }
    // A splat covers at least one sample of the pixel that contains its centre.
    vec2 e = d - offset;
    bool owns = mask == 0 && max(abs(e.x), abs(e.y)) <= 0.5;
    return owns ? 1u << nearest_sample(-e) : mask;
}

// Adds the samples that a splat covers, if `is_splat`.
void add_coverage(TileSplat splat, TileSplat solid, vec2 offset, bool is_splat) {
    for (uint r = 0; r < ROWS; r++) {
        vec2 m, d = vec2(lane_pixel(r));
        float key, rank;
        bool has_fragment = tile_fragment(splat, d, m, key, rank) && is_splat;
        uint mask = mask_on_tile(solid, offset, d);
        coverage_masks[r] |= has_fragment ? mask : 0;
    }
}

void add_coverage_batch(uint count, uint id, uvec2 origin) {
    Splat splat = splat_of(id);
    vec2 centre = vec2(origin) + 0.5, variance = variance_of(splat);
    TileSplat lane_splat = splat_on_tile(ellipse_of(splat, visibility_variance(variance), clip_of(id)), centre);
    TileSplat lane_solid = splat_on_tile(solid_ellipse(splat, clip_of(id)), centre);
    vec2 lane_offset = splat.offset - (centre - anchor_of(splat));
    uint s = 0;
    do {
        TileSplat current = shuffle(lane_splat, s), solid = shuffle(lane_solid, s);
        add_coverage(current, solid, shuffle(lane_offset, s), s < count);
#if COVERAGE_UNROLLED == 2
        current = shuffle(lane_splat, s + 1);
        solid = shuffle(lane_solid, s + 1);
        add_coverage(current, solid, shuffle(lane_offset, s + 1), s + 1 < count);
#endif
        s += COVERAGE_UNROLLED;
    } while (s < count);
    update_coverage_cull_key();
}

#define WALK walk_coverage
#ifndef COVERAGE_STEPS
#define COVERAGE_STEPS 12000
#endif
#define WALK_STEPS COVERAGE_STEPS
#define WALK_UNROLLED COVERAGE_UNROLLED
#define WALK_CULL_KEY coverage_cull_key
#define WALK_BATCH(count, id) add_coverage_batch(count, id, origin)
#include "lib/walk.glsl"

// Computes coverage of the tile, after visibility: only visible pixels are covered.
void compute_coverage(uvec2 origin) {
    for (uint r = 0; r < ROWS; r++) coverage_masks[r] = is_resumed() ? coverage_masks[r] : 0;
    for (uint r = 0; r < ROWS; r++) depths[r] = is_in_viewport(origin + lane_pixel(r)) ? depths[r] : 0.0;
    update_coverage_cull_key();
    walk_coverage(origin, origin + TILE - 1, SCRATCH, SCRATCH, true);
}
