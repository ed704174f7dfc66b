// Coverage on a tile: masks of the 16 samples of each pixel that lie on a surface: see lib/coverage.glsl.
//
// A splat covers an interval of each scanline of samples, so that lanes own rows of pixels here: lane % TILE is the row, and lanes of the
// same row share its samples.

#include "lib/coverage.glsl"

// Of each of the lane's pixels, as other stages own them: a bit per sample. MIXED: those that the nearest surface covers.
uint coverage_masks[ROWS], nearest_masks[ROWS];

const uint LANE_SAMPLES = SAMPLES * TILE / LANES;
const uint SAMPLE_WORDS = (LANE_SAMPLES + 3) / 4;

// Covered samples of the lane's row, a byte per sample, a bit per column.
uint row_coverage[SAMPLE_WORDS];
// MIXED: those that splats of the nearest surface cover, and the depths of the row's pixels.
uint row_nearest[SAMPLE_WORDS];
float row_depths[TILE];
// Visible columns of the row, in each byte.
uint row_visible;

// Whether the covered samples are known, so that those of the nearest surface alone are sought.
#ifndef COVERAGE_KNOWN
#define COVERAGE_KNOWN false
#endif

// As UNROLLED: 2 is slower than 1 but takes half the iterations.
#ifndef COVERAGE_UNROLLED
#define COVERAGE_UNROLLED 1
#endif

// Mask of the columns from x0 to x1.
uint column_mask(float x0, float x1) {
    uint first = uint(clamp(ceil(x0), 0.0, float(TILE))), beyond = uint(clamp(float(TILE - 1) - floor(x1), 0.0, float(TILE)));
    return (0xffu << first) & (0xffu >> beyond) & 0xffu;
}

// Visible pixels of the tile with uncovered samples, or MIXED with samples that the nearest surface does not cover: four rows in each word, a
// bit per column.
uvec2 incomplete_pixels;
// κ below which splats are skipped: 0 while pixels have uncovered samples.
float coverage_cull_key;

// Columns of the lane's row with samples that are not covered.
uint incomplete_columns(const uint row_samples[SAMPLE_WORDS]) {
    uint covered = ~0u;
    for (uint w = 0; w < SAMPLE_WORDS; w++) covered &= row_samples[w];
    if (LANE_SAMPLES >= 4) covered &= covered >> 16;
    return row_visible & ~(covered & covered >> 8) & 0xffu;
}

// Pixels of the tile, from the columns of each lane's row.
uvec2 pixels_of_rows(uint columns) {
    uint row = lane % TILE;
    uvec2 pixels = row < 4 ? uvec2(columns << 8 * row, 0) : uvec2(0, columns << 8 * (row - 4));
    for (uint k = 0; k < STEPS; k++) {
        pixels.x |= shuffle(pixels.x, lane ^ 1u << k);
        pixels.y |= shuffle(pixels.y, lane ^ 1u << k);
    }
    return pixels;
}

void update_incomplete_pixels() {
    uint columns = incomplete_columns(row_coverage);
    if (MIXED) {
        bool is_complete = workgroup_ballot(columns != 0) == 0;
        incomplete_pixels = pixels_of_rows(incomplete_columns(row_nearest));
        // Splats of the nearest surface are among those that visibility visited, if these have been recorded.
        bool is_nearest_complete = visited_count <= MOST_VISITED || incomplete_pixels == uvec2(0);
        coverage_cull_key = !is_complete ? 0.0 : is_nearest_complete ? 1e30 : 0.999999 * least_depth();
    } else {
        incomplete_pixels = pixels_of_rows(columns);
        coverage_cull_key = incomplete_pixels == uvec2(0) ? 1e30 : 0.0;
    }
}

// Four bits as the lowest ones of four bytes.
uint spread(uint bits) {
    return bits & 1u | (bits & 2u) << 7 | (bits & 4u) << 14 | (bits & 8u) << 21;
}

// The lowest bits of four bytes as four bits.
uint gather(uint bits) {
    return (bits & 0x1010101u) * 0x1020408u >> 24 & 0xfu;
}

// Whether a splat may cover samples of incomplete pixels: its centre relative to the tile, and half its width and height, px.
bool reaches_incomplete_pixels(vec2 centre, vec2 reach) {
    uint columns = column_mask(centre.x - reach.x, centre.x + reach.x), rows = column_mask(centre.y - reach.y, centre.y + reach.y);
    return ((spread(rows) * columns & incomplete_pixels.x) | (spread(rows >> 4) * columns & incomplete_pixels.y)) != 0;
}

// Mask of the columns on the kept side of a clip line, whose value at column 0 is `value`.
uint kept_columns(float value, float slope) {
    float x = -value / slope;
    if (slope == 0.0) return value >= 0.0 ? 0xffu : 0u;
    return slope > 0.0 ? column_mask(x, float(TILE)) : column_mask(0.0, x);
}

// The line beyond which a convex surface has turned away from the eye, on the tile: at column `start` + `slope` y. `side` is above 0 if the
// columns beyond are kept.
struct Turn {
    float start;
    float slope;
    float side;
};

const Turn NO_TURN = Turn(1e9, 0.0, -1.0);
// Least slope along a row relative to that of the plane: nearly horizontal lines are that much off.
const float LEAST_SLOPE = 1e-6;

Turn turn_on_tile(TileSplat solid, float least_key) {
    vec3 plane = solid.plane.grid + solid.plane.rest;
    float value = solid.plane.grid.x - least_key + solid.plane.rest.x;
    float least = max(LEAST_SLOPE * length(plane.yz), 1e-30);
    float slope = abs(plane.y) < least ? least : plane.y;
    return least_key > 0.0 ? Turn(-value / slope, -plane.z / slope, slope) : NO_TURN;
}

Turn shuffle(Turn o, uint from) {
    return Turn(shuffle(o.start, from), shuffle(o.slope, from), shuffle(o.side, from));
}

// Mask of the columns whose sample `d`, in column 0, is not beyond the turn line.
uint unturned_columns(Turn turn, vec2 d) {
    float x = turn.start + turn.slope * d.y - d.x;
    return turn.side > 0.0 ? column_mask(x, float(TILE)) : column_mask(0.0, x);
}

// Mask of the columns whose pixels have their sample inside a solid ellipse; `d` is the sample in column 0, relative to the tile.
uint sample_columns(TileSplat solid, Turn turn, vec2 d) {
    float limit = SOLID * frame.cutoff;
    uint mask = 0;
    if (on_plane()) {
        for (uint x = 0; x < TILE; x++) {
            vec2 at = d + vec2(x, 0.0);
            vec2 u = value_at(solid.kernel, at);
            float nearness = inverse_depth(value_at(solid.plane, at)) / inverse_depth(solid.key_centre);
            u /= clamp(nearness, 1.0 / MOST_STRETCH, MOST_STRETCH);
            bool inside = rim() > 1.0 ? max(abs(u.x), abs(u.y)) <= limit : dot(u, u) <= limit * limit;
            mask |= uint(inside) << x;
        }
    } else {
        vec2 u = value_at(solid.kernel, d), slope = vec2(solid.kernel.u.y + solid.kernel.u_rest.y, solid.kernel.v.y + solid.kernel.v_rest.y);
        if (rim() > 1.0) {
            vec2 a = (-limit - u) / slope, b = (limit - u) / slope;
            vec2 first = min(a, b), last = max(a, b);
            mask = column_mask(max(first.x, first.y), min(last.x, last.y));
        } else {
            float square = dot(slope, slope), across = u.x * slope.y - u.y * slope.x;
            float discriminant = square * limit * limit - across * across;
            float middle = -dot(u, slope) / square, reach = sqrt(max(discriminant, 0.0)) / square;
            mask = discriminant >= 0.0 ? column_mask(middle - reach, middle + reach) : 0u;
        }
    }
    if (CURVATURES) mask &= unturned_columns(turn, d);
    if (CLIPS) {
        uint kept[2];
        for (uint i = 0; i < 2; i++) {
            vec3 line = solid.lines[i];
            kept[i] = kept_columns(line.x + dot(line.yz, d) + SEAM, line.y);
        }
        mask &= solid.concave > 0.0 ? kept[0] | kept[1] : kept[0] & kept[1];
    }
    return mask;
}

// Adds the samples of a word that a splat covers at the columns of its `fragments`, of which `nearest` are of the nearest surface; returns the
// columns of which it covers samples.
uint add_samples(TileSplat solid, Turn turn, float y, uint fragments, uint nearest, const uint word) {
    uint any = 0, added = 0;
    [[unroll]] for (uint j = 0; j < LANE_SAMPLES - 4 * word && j < 4; j++) {
        uint k = lane / TILE * LANE_SAMPLES + 4 * word + j;
        uint columns = sample_columns(solid, turn, vec2(0.0, y) + sample_position(k));
        any |= columns;
        added |= (columns & fragments) << 8 * j;
    }
    row_coverage[word] |= added;
    if (MIXED) row_nearest[word] |= added & 0x1010101u * nearest;
    return any;
}

// Adds the samples that a splat covers, if `is_splat`: see coverage_mask. `solid` is its solid ellipse, `turn` its turn line, `offset` its centre
// relative to the tile, px, `nearest` the sample nearest to it.
void add_coverage(TileSplat splat, TileSplat solid, Turn turn, vec2 offset, uint nearest, bool is_splat) {
    float y = float(lane % TILE);
    uint first = lane / TILE * LANE_SAMPLES;
    uint fragments = 0, of_nearest = 0;
    for (uint x = 0; x < TILE; x++) {
        vec2 m;
        float key, rank;
        fragments |= uint(tile_fragment(splat, vec2(x, y), m, key, rank)) << x;
        if (MIXED) of_nearest |= uint(ranked(key, rank) >= row_depths[x]) << x;
    }
    fragments = is_splat ? fragments : 0;
    // One by one: the compiler does not unroll a loop of that many instructions, and dynamic indexing is slow.
    uint any = add_samples(solid, turn, y, fragments, of_nearest, 0);
    if (SAMPLE_WORDS > 1) any |= add_samples(solid, turn, y, fragments, of_nearest, 1);
    if (SAMPLE_WORDS > 2) any |= add_samples(solid, turn, y, fragments, of_nearest, 2);
    if (SAMPLE_WORDS > 3) any |= add_samples(solid, turn, y, fragments, of_nearest, 3);
    for (uint k = 3; k < STEPS; k++) any |= shuffle(any, lane ^ 1u << k);
    // A splat covers at least one sample of the pixel that contains its centre.
    uint centre = abs(y - offset.y) <= 0.5 ? column_mask(offset.x - 0.5, offset.x + 0.5) : 0;
    uint uncovered = centre & ~any & fragments;
    for (uint w = 0; w < SAMPLE_WORDS; w++) {
        uint byte = nearest - first - 4 * w;
        row_coverage[w] |= byte < 4 ? uncovered << 8 * byte : 0;
        if (MIXED) row_nearest[w] |= byte < 4 ? (uncovered & of_nearest) << 8 * byte : 0;
    }
}

// A splat that covers samples of the tile.
struct CoveringSplat {
    TileSplat splat; // by the variance of visibility
    TileSplat solid;
    Turn turn;
    vec2 offset;     // of its centre from the tile's first pixel, px
    uint nearest;    // sample nearest to the centre
    bool reaches;    // it may cover samples of incomplete pixels
};

CoveringSplat covering_splat(uint id, uvec2 origin) {
    Splat splat = splat_of(id);
    vec2 centre = vec2(origin) + 0.5, variance = visibility_variance(variance_of(splat));
    CoveringSplat covering;
    covering.splat = splat_on_tile(ellipse_of(splat, variance, clip_of(id)), centre);
    covering.solid = splat_on_tile(solid_ellipse(splat, clip_of(id)), centre);
    covering.turn = CURVATURES ? turn_on_tile(covering.solid, least_key(splat)) : NO_TURN;
    covering.offset = splat.offset - (centre - anchor_of(splat));
    covering.nearest = nearest_sample(covering.offset - ceil(covering.offset - 0.5));
    // More than rounding moves the edges of its fragments.
    vec2 reach = largest_stretch() * half_extent(splat.axis, variance) + 0.01;
    covering.reaches = reaches_incomplete_pixels(covering.offset, reach);
    return covering;
}

CoveringSplat shuffle(CoveringSplat o, uint from) {
    CoveringSplat result = o;
    result.splat = shuffle(o.splat, from);
    result.solid = shuffle(o.solid, from);
    if (CURVATURES) result.turn = shuffle(o.turn, from);
    result.offset = shuffle(o.offset, from);
    result.nearest = shuffle(o.nearest, from);
    return result;
}

// Adds the samples of the splat that lane `from` has.
void add_coverage_of(uint from, CoveringSplat splat, bool is_splat) {
    CoveringSplat current = shuffle(splat, from);
    add_coverage(current.splat, current.solid, current.turn, current.offset, current.nearest, is_splat);
}

void add_coverage_batch(uint count, uint id, uvec2 origin) {
    CoveringSplat splat = covering_splat(id, origin);
    bool reaches = lane < count && splat.reaches;
    for (uint first = 0; first < LANES; first += 32) {
        uint remaining = workgroup_ballot(reaches && lane / 32 == first / 32);
        do {
            uint from = first + uint(max(findLSB(remaining), 0));
            add_coverage_of(from, splat, remaining != 0);
            remaining &= remaining - 1;
#if COVERAGE_UNROLLED == 2
            from = first + uint(max(findLSB(remaining), 0));
            add_coverage_of(from, splat, remaining != 0);
            remaining &= remaining - 1;
#endif
        } while (remaining != 0);
    }
    update_incomplete_pixels();
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

// Value of each lane's pixels in the columns of the lane's row, from the pixels that lanes own.
#define GATHER_ROW(TYPE, VALUES, ROW)                                                                                      \
    for (uint x = 0; x < TILE; x++) {                                                                                      \
        for (uint r = 0; r < ROWS; r++) {                                                                                  \
            TYPE value = shuffle(VALUES[r], x + TILE * (lane % TILE % ROW_STEP));                                          \
            ROW[x] = lane % TILE / ROW_STEP == r ? value : ROW[x];                                                         \
        }                                                                                                                  \
    }

// The samples of the lane's pixel `row`, from the samples that lanes have of rows.
uint mask_of_pixel(const uint row_samples[SAMPLE_WORDS], uint row) {
    uvec2 pixel = lane_pixel(row);
    uint mask = 0;
    for (uint first = 0; first < SAMPLES; first += LANE_SAMPLES) {
        for (uint w = 0; w < SAMPLE_WORDS; w++) {
            uint word = shuffle(row_samples[w], pixel.y + TILE * (first / LANE_SAMPLES));
            mask |= gather(word >> pixel.x) << first + 4 * w;
        }
    }
    return mask;
}

// Computes coverage of the tile, after visibility: only visible pixels are covered.
void compute_coverage(uvec2 origin) {
    row_visible = 0;
    uint row_full = 0;
    for (uint r = 0; r < ROWS; r++) {
        depths[r] = is_in_viewport(origin + lane_pixel(r)) ? depths[r] : 0.0;
        uint columns = uint(depths[r] > 0.0) << lane % TILE | (full_pixels >> r & 1u) << 8 + lane % TILE;
        for (uint k = 0; k < 3; k++) columns |= shuffle(columns, lane ^ 1u << k);
        uint row = lane % TILE;
        columns = shuffle(columns, TILE * (row % ROW_STEP));
        row_visible = row / ROW_STEP == r ? columns & 0xffu : row_visible;
        row_full = row / ROW_STEP == r ? columns >> 8 : row_full;
    }
    if (MIXED) GATHER_ROW(float, depths, row_depths)
    const uint bytes = LANE_SAMPLES < 4 ? 0x101u : 0x1010101u;
    row_visible *= bytes;
    for (uint w = 0; w < SAMPLE_WORDS; w++) row_nearest[w] = row_full * bytes;
    for (uint w = 0; w < SAMPLE_WORDS; w++) row_coverage[w] = COVERAGE_KNOWN ? ~0u : row_nearest[w];
    update_incomplete_pixels();
    // First those that visibility visited: they cover most tiles alone.
    WORKGROUP_BARRIER();
    bool lacks = incomplete_pixels != uvec2(0), all_recorded = visited_count <= MOST_VISITED;
    uint first = all_recorded ? 0 : SCRATCH, end = all_recorded && lacks ? visited_count : first;
    walk_coverage(origin, origin + TILE - 1, first, end, lacks);
    for (uint r = 0; r < ROWS; r++) {
        if (!COVERAGE_KNOWN) coverage_masks[r] = (is_resumed() ? coverage_masks[r] : 0) | mask_of_pixel(row_coverage, r);
        if (MIXED) nearest_masks[r] = mask_of_pixel(row_nearest, r);
    }
}
