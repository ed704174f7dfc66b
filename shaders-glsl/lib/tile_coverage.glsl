// Coverage on a tile: which of 16 samples of each of the lane's pixels lie on a surface: see lib/coverage.glsl.

#include "lib/coverage.glsl"

layout(constant_id = 31) const bool COVERAGE = false; // α is the part of a pixel that is covered

uint covered[ROWS];

// Behind it nothing is wanted: less than all κ as long as samples of a pixel that shows something are missing.
float covered_behind;

void update_covered() {
    uint all_of = ALL_SAMPLES;
    for (uint r = 0; r < ROWS; r++) all_of &= depths[r] > 0.0 ? covered[r] : ALL_SAMPLES;
    covered_behind = team_min(all_of == ALL_SAMPLES ? 2.0 : 0.0) > 1.0 ? 1e30 : 0.0;
}

// The samples that a splat covers d px from the tile's first pixel, where it has a fragment; see coverage_mask. `solid` is of its solid ellipse.
uint mask_on_tile(TileSplat solid, vec2 offset, vec2 d) {
    float limit = SOLID * frame.cutoff;
    float nearness = on_plane() ? value_at(solid.plane, d) / solid.key_centre : 1.0;
    vec2 slope = on_plane() ? (solid.plane.grid.yz + solid.plane.rest.yz) / solid.key_centre : vec2(0.0);
    vec2 centre = value_at(solid.place, d);
    uint mask = 0;
    for (uint k = 0; k < SAMPLES; k++) {
        vec2 s = sample_at(k);
        vec2 u = centre + vec2(dot(solid.place.u.yz, s), dot(solid.place.v.yz, s));
        if (on_plane()) u /= clamp(nearness + dot(slope, s), 1.0 / MOST_STRETCH, MOST_STRETCH);
        bool inside = rim() > 1.0 ? max(abs(u.x), abs(u.y)) <= limit : dot(u, u) <= limit * limit;
        if (CLIPS) inside = inside && clip_distance(solid, d + s) >= -SEAM;
        mask |= uint(inside) << k;
    }
    // Where a splat is, there is surface, however little.
    vec2 e = d - offset;
    bool owns = mask == 0 && max(abs(e.x), abs(e.y)) <= 0.5;
    return owns ? 1u << nearest_sample(-e) : mask;
}

void take_coverage(uint count, uint id, uvec2 low) {
    Splat splat = splat_of(id);
    vec2 origin = vec2(low) + 0.5, variance = variance_of(splat);
    TileSplat own = splat_on_tile(ellipse_of(splat, visibility_variance(variance), clip_of(id)), origin);
    TileSplat own_solid = splat_on_tile(solid_of(splat, clip_of(id)), origin);
    vec2 own_offset = splat.offset - (origin - anchor_of(splat));
    uint s = 0;
    do {
        TileSplat one = of_lane(own, s), solid = of_lane(own_solid, s);
        vec2 offset = of_lane(own_offset, s);
        for (uint r = 0; r < ROWS; r++) {
            vec2 m, d = vec2(lane_pixel(r));
            float key, rank;
            bool there = tile_fragment(one, d, m, key, rank) && s < count;
            uint mask = mask_on_tile(solid, offset, d);
            covered[r] |= there ? mask : 0;
        }
        s++;
    } while (s < count);
    update_covered();
}

#define WALK walk_coverage
#ifndef COVERAGE_STEPS
#define COVERAGE_STEPS 12000
#endif
#define WALK_STEPS COVERAGE_STEPS
#define WALK_BEHIND covered_behind
#define WALK_TAKE(count, id) take_coverage(count, id, low)
#include "lib/walk.glsl"

// After visibility: only what shows something is covered.
void find_covered(uvec2 low) {
    for (uint r = 0; r < ROWS; r++) covered[r] = goes_on() ? covered[r] : 0;
    for (uint r = 0; r < ROWS; r++) depths[r] = is_on_picture(low + lane_pixel(r)) ? depths[r] : 0.0;
    update_covered();
    walk_coverage(low, low + TILE - 1);
}
