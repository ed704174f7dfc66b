// Visibility on a tile: κ of the nearest surface per pixel, moved back by ε, or exact with NEAREST_SPLAT; 0 in empty pixels.

#ifdef NEAREST_SPLAT
uint nearest_splats[ROWS]; // id of the nearest splat
#endif

// COVERAGE: the lane's pixels that lie within the solid part of a disc, of which all samples are covered; a bit each. MIXED: within one of
// the nearest surface.
uint full_pixels = 0;
// MIXED: κ of the nearest disc within whose solid part the pixel lies.
float full_keys[ROWS];

// Whether depths are those of a dispatch before: of the previous slice, or of the splats that face the eye, before sides.
bool has_depths() {
    return is_resumed() || has_fronts();
}

#ifndef NEAREST_SPLAT
// Loads the depth of the lane's pixel `row` from the bits that depth_bits gave.
void load_depth(uint row, uint bits) {
    depths[row] = uintBitsToFloat(bits & ~FULL_PIXEL);
    full_pixels |= uint((bits & FULL_PIXEL) != 0) << row;
    full_keys[row] = (bits & FULL_PIXEL) != 0 ? depths[row] : 0.0;
}

// Bits of the depth of the lane's pixel `row`, and of the splats that face the eye whether the pixel is full.
uint depth_bits(uint row) {
    return floatBitsToUint(depths[row]) | (is_of_fronts() && (full_pixels >> row & 1u) != 0 ? FULL_PIXEL : 0);
}
#endif

// Distance of the farthest sample from a pixel's centre, px: below it.
const float FARTHEST_SAMPLE = 0.67;

// Largest squared distance, σ of visibility's ellipse, of pixel centres that are FARTHEST_SAMPLE inside the solid ellipse, and the least κ of
// centres that far before the turn line. No pixel is full by discs with clips, or whose shapes are no ellipses.
vec2 full_limits(Splat splat, vec2 variance, vec2 visible, uint clip) {
    float minor = SOLID * frame.cutoff * sqrt(variance.y), eroded = minor - FARTHEST_SAMPLE;
    bool is_ellipse = !on_plane() && rim() == 1.0 && clip == NO_CLIP && eroded > 0.0;
    float distance = eroded / sqrt(visible.y);
    return vec2(is_ellipse ? distance * distance : -1.0, least_key(splat) + FARTHEST_SAMPLE * length(splat.plane_hi.yz));
}

// Farthest κ of the tile's pixels: splats behind it are occluded.
float visibility_cull_key;

void update_visibility_cull_key() {
    float least = depths[0];
    for (uint r = 1; r < ROWS; r++) least = min(least, depths[r]);
    visibility_cull_key = workgroup_min(least);
}

// Updates the depths with splat `id`, if `is_splat`.
void add_visibility(TileSplat splat, vec2 limit, vec2 full, uint id, bool is_splat) {
    for (uint r = 0; r < ROWS; r++) {
        vec2 m;
        float key, rank;
        bool has_fragment = tile_fragment(splat, vec2(lane_pixel(r)), m, key, rank) && is_splat;
        bool is_full = COVERAGE && has_fragment && dot(m, m) <= full.x && (!CURVATURES || key >= full.y);
        if (MIXED) full_keys[r] = is_full ? max(full_keys[r], key) : full_keys[r];
        else full_pixels |= uint(is_full) << r;
#ifdef NEAREST_SPLAT
        float depth = ranked(min(key, limit.x), rank);
        bool nearer = has_fragment && (depth > depths[r] || depth == depths[r] && id < nearest_splats[r]);
        depths[r] = nearer ? depth : depths[r];
        nearest_splats[r] = nearer ? id : nearest_splats[r];
#else
        float depth = ranked(visibility_key(key, limit.x, limit.y), rank);
        depths[r] = has_fragment ? max(depths[r], depth) : depths[r];
#endif
    }
}

// Updates the depths with the splat that lane `from` has.
void add_visibility_of(uint from, TileSplat splat, vec2 limit, vec2 full, uint id, bool is_splat) {
    vec2 of_splat = COVERAGE ? shuffle(full, from) : vec2(0.0);
    add_visibility(shuffle(splat, from), shuffle(limit, from), of_splat, shuffle(id, from), is_splat);
}

void add_visibility_batch(uint count, uint id, uvec2 origin) {
    Splat splat = splat_of(id);
    vec2 variance = visibility_variance(variance_of(splat));
    TileSplat lane_splat = splat_on_tile(ellipse_of(splat, variance, clip_of(id)), vec2(origin) + 0.5);
    vec2 limits = vec2(splat.key_disc, splat.epsilon), lane_full = vec2(0.0);
    if (COVERAGE) lane_full = full_limits(splat, variance_of(splat), variance, clip_of(id));
    // Unrolled: loop iterations are limited on lavapipe, and a single splat leaves it idle.
    if (CULL_AUTO && LANES <= 32) {
        uint remaining = workgroup_ballot(lane < count && (is_of_fronts() || is_back(splat)));
        do {
            for (uint k = 0; k < UNROLLED; k++) {
                add_visibility_of(uint(max(findLSB(remaining), 0)), lane_splat, limits, lane_full, id, remaining != 0);
                remaining &= remaining - 1;
            }
        } while (remaining != 0);
    } else {
        uint s = 0;
        do {
            for (uint k = 0; k < UNROLLED; k++) add_visibility_of(s + k, lane_splat, limits, lane_full, id, s + k < count);
            s += UNROLLED;
        } while (s < count);
    }
    update_visibility_cull_key();
}

#define WALK walk_visibility
#ifndef VISIBILITY_STEPS
#define VISIBILITY_STEPS 24000
#endif
#define WALK_STEPS VISIBILITY_STEPS
#define WALK_CULL_KEY visibility_cull_key
#define WALK_RECORDS
#define WALK_BATCH(count, id) add_visibility_batch(count, id, origin)
#include "lib/walk.glsl"

// Computes the depths of the tile, from empty ones or from those of the dispatch before.
void compute_visibility(uvec2 origin) {
    // Pixels outside the viewport never hold back the cull key.
    for (uint r = 0; r < ROWS; r++) {
        depths[r] = !is_in_viewport(origin + lane_pixel(r)) ? 1e30 : has_depths() ? depths[r] : 0.0;
#ifdef NEAREST_SPLAT
        nearest_splats[r] = is_resumed() ? nearest_splats[r] : 0;
#endif
    }
    if (MIXED && !has_depths()) for (uint r = 0; r < ROWS; r++) full_keys[r] = 0.0;
    update_visibility_cull_key();
    visited_count = 0;
    walk_visibility(origin, origin + TILE - 1, 0, 0, true);
    if (MIXED) {
        full_pixels = 0;
        for (uint r = 0; r < ROWS; r++) full_pixels |= uint(full_keys[r] > 0.0 && full_keys[r] >= depths[r]) << r;
    }
}
