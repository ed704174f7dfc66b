// The surface behind on a tile: κ of the nearest splat that covers samples which the nearest surface leaves free, moved back by ε; lanes own rows
// of pixels as in lib/tile_coverage.glsl.

// Samples of the lane's row that other splats than those of the nearest surface cover, as in row_coverage.
uint row_free[SAMPLE_WORDS];
// Depths of the surface behind in the row's pixels; 0 where there is none.
float row_behind[TILE];

// Farthest κ of the surface behind over the tile's pixels with free samples: splats behind it do not show.
float behind_cull_key;

void update_behind_cull_key() {
    float least = 1e30;
    for (uint x = 0; x < TILE; x++) {
        uint free = 0;
        for (uint w = 0; w < SAMPLE_WORDS; w++) free |= row_free[w] & 0x1010101u << x;
        least = free != 0 ? min(least, row_behind[x]) : least;
    }
    behind_cull_key = workgroup_min(least);
}

// Columns of a word of free samples of which a splat covers one at its `fragments`; adds to `any` the columns of which it covers samples.
uint free_columns(TileSplat solid, Turn turn, float y, uint fragments, const uint word, inout uint any) {
    uint free = 0;
    [[unroll]] for (uint j = 0; j < LANE_SAMPLES - 4 * word && j < 4; j++) {
        uint k = lane / TILE * LANE_SAMPLES + 4 * word + j;
        uint columns = sample_columns(solid, turn, vec2(0.0, y) + sample_position(k));
        any |= columns;
        free |= columns & fragments & row_free[word] >> 8 * j;
    }
    return free;
}

// Updates the depths with a splat, if `is_splat`; `limit` is its nearest κ and its ε, others as of add_coverage.
void add_behind(TileSplat splat, TileSplat solid, Turn turn, vec2 offset, uint nearest, vec2 limit, bool is_splat) {
    float y = float(lane % TILE);
    uint first = lane / TILE * LANE_SAMPLES;
    uint fragments = 0;
    float keys[TILE];
    for (uint x = 0; x < TILE; x++) {
        vec2 m;
        float key, rank;
        bool has_fragment = tile_fragment(splat, vec2(x, y), m, key, rank);
        fragments |= uint(has_fragment && ranked(key, rank) < row_depths[x]) << x;
        keys[x] = ranked(visibility_key(key, limit.x, limit.y), rank);
    }
    fragments = is_splat ? fragments : 0;
    uint any = 0, free = free_columns(solid, turn, y, fragments, 0, any);
    if (SAMPLE_WORDS > 1) free |= free_columns(solid, turn, y, fragments, 1, any);
    if (SAMPLE_WORDS > 2) free |= free_columns(solid, turn, y, fragments, 2, any);
    if (SAMPLE_WORDS > 3) free |= free_columns(solid, turn, y, fragments, 3, any);
    for (uint k = 3; k < STEPS; k++) any |= shuffle(any, lane ^ 1u << k);
    // A splat covers at least one sample of the pixel that contains its centre.
    uint centre = abs(y - offset.y) <= 0.5 ? column_mask(offset.x - 0.5, offset.x + 0.5) : 0;
    uint uncovered = centre & ~any & fragments;
    for (uint w = 0; w < SAMPLE_WORDS; w++) {
        uint byte = nearest - first - 4 * w;
        free |= byte < 4 ? uncovered & row_free[w] >> 8 * byte : 0;
    }
    for (uint k = 3; k < STEPS; k++) free |= shuffle(free, lane ^ 1u << k);
    for (uint x = 0; x < TILE; x++) row_behind[x] = (free >> x & 1u) != 0 ? max(row_behind[x], keys[x]) : row_behind[x];
}

void add_behind_batch(uint count, uint id, uvec2 origin) {
    CoveringSplat covering = covering_splat(id, origin);
    Splat splat = splat_of(id);
    vec2 limits = vec2(splat.key_disc, splat.epsilon);
    bool reaches = lane < count && covering.reaches;
    for (uint first = 0; first < LANES; first += 32) {
        uint remaining = workgroup_ballot(reaches && lane / 32 == first / 32);
        do {
            uint from = first + uint(max(findLSB(remaining), 0));
            CoveringSplat current = shuffle(covering, from);
            add_behind(
                current.splat, current.solid, current.turn, current.offset, current.nearest, shuffle(limits, from), remaining != 0);
            remaining &= remaining - 1;
        } while (remaining != 0);
    }
    update_behind_cull_key();
}

#define WALK walk_behind
#define WALK_STEPS BEHIND_STEPS
#define WALK_UNROLLED 1
#define WALK_CULL_KEY behind_cull_key
#define WALK_RECORDS
#define WALK_BATCH(count, id) add_behind_batch(count, id, origin)
#include "lib/walk.glsl"

// Computes the depths of the surface behind, from the samples that are free and from the depths so far.
void compute_behind(uvec2 origin) {
    update_behind_cull_key();
    visited_count = 0;
    walk_behind(origin, origin + TILE - 1, 0, 0, true);
    // From rows to the pixels that lanes own.
    for (uint r = 0; r < ROWS; r++) {
        nearest_depths[r] = depths[r];
        for (uint x = 0; x < TILE; x++) {
            float depth = shuffle(row_behind[x], lane_pixel(r).y);
            depths[r] = lane % TILE == x ? depth : depths[r];
        }
    }
}
