// Tiles: TILE × TILE px that a workgroup rasterizes splats to. Each lane owns pixels of one column, ROW_STEP apart, in registers.
// Passes that have a dispatch before pass sides define FRONT_TILES.

#define BOX_ACCESS readonly
#include "lib/box.glsl"
#include "lib/hierarchy.glsl"
#include "lib/tile_size.glsl"
#include "lib/workgroup.glsl"

layout(constant_id = 31) const bool COVERAGE = false; // α is the covered part of a pixel
layout(constant_id = 47) const bool SLICED = false;
layout(constant_id = 82) const bool LIMITED_LOOPS = true; // the device stops long loops
layout(constant_id = 72) const bool MIXED = false; // pixels at edges show the surface behind, too
#ifdef FRONT_TILES
layout(constant_id = 68) const bool CULL_AUTO = false; // pass sides culls some splats that face away
layout(constant_id = 80) const bool OCCLUSION_CULLING = false; // pass hidden culls clusters
#else
const bool CULL_AUTO = false, OCCLUSION_CULLING = false;
#endif

// Whether this dispatch resumes the state of the previous slice, and whether no further slice follows.
bool is_resumed() {
    return SLICED && hierarchy.slice > 0;
}

// Whether this dispatch, the one before pass sides, draws only splats that face the eye.
bool is_of_fronts() {
    return CULL_AUTO && hierarchy.fronts != 0;
}

// Whether this dispatch draws them in the tiles that revealed clusters may change.
bool is_of_revealed() {
    return CULL_AUTO && OCCLUSION_CULLING && hierarchy.fronts == 2;
}

// Whether the depths of the splats that face the eye are known: others are to be added.
bool has_fronts() {
    return CULL_AUTO && hierarchy.fronts == 0;
}

bool is_last_slice() {
    return !SLICED || hierarchy.slice + 1 == hierarchy.slices;
}

const uint ROWS = TILE * TILE / LANES;
const uint ROW_STEP = LANES / TILE;

// Loop over the lane's pixels for code that runs once a tile, which unrolled would be a sixth of what a driver compiles. Such a loop reads and
// writes values of row 0 and rotates them, since dynamic indexing is slow.
#define FOR_ROWS(R) [[dont_unroll]] for (uint R = 0; R < ROWS; R++)

// Moves the values of each row to the row before, those of row 0 to the last one.
#define ROTATE(TYPE, VALUES)                                                                                               \
    {                                                                                                                      \
        TYPE of_first = VALUES[0];                                                                                         \
        for (uint i = 1; i < ROWS; i++) VALUES[i - 1] = VALUES[i];                                                         \
        VALUES[ROWS - 1] = of_first;                                                                                       \
    }

// First pixel of the workgroup's tile: even rows of tiles first, then odd ones, so that devices that split dispatches into halves balance
// the load.
uvec2 tile_origin() {
    uint half_way = (gl_NumWorkGroups.y + 1) / 2, y = gl_WorkGroupID.y;
    return TILE * (hierarchy.first_tile + uvec2(gl_WorkGroupID.x, y < half_way ? 2 * y : 2 * (y - half_way) + 1));
}

// The lane's pixel number `row`, relative to the tile.
uvec2 lane_pixel(uint row) {
    return uvec2(lane % TILE, lane / TILE + ROW_STEP * row);
}

bool is_in_viewport(uvec2 pixel) {
    return all(lessThan(pixel, uvec2(frame.viewport)));
}

// An affine function on the tile, evaluated with compensated rounding: value at the tile's first pixel and derivatives along x and y, per
// px, rounded to a grid so coarse that their sums are exact, and the remainders.
struct Affine {
    vec3 grid;
    vec3 rest;
};

Affine on_tile(vec3 hi, vec3 lo) {
    vec3 size = abs(hi) * vec3(1.0, TILE, TILE);
    float most = min(max(size.x, max(size.y, size.z)), 1e30);
    // Grid of 2⁻¹⁸ of the power of two below `most`: sums stay below 2²⁴ steps.
    float shift = 48.0 * uintBitsToFloat(floatBitsToUint(most) & 0x7f800000u);
    precise vec3 shifted = hi + shift;
    precise vec3 grid = shifted - shift;
    precise vec3 rest = (hi - grid) + lo;
    return Affine(grid, rest);
}

float value_at(Affine f, vec2 d) {
    precise float grid = f.grid.x + f.grid.y * d.x + f.grid.z * d.y;
    return grid + (f.rest.x + f.rest.y * d.x + f.rest.z * d.y);
}

Affine shuffle(Affine f, uint from) {
    return Affine(shuffle(f.grid, from), shuffle(f.rest, from));
}

// A plane relative to the tile, with compensated rounding: see plane_at.
Affine plane_on_tile(vec3 hi, vec3 lo, vec2 d) {
    vec2 x = two_product(hi.y, d.x), y = two_product(hi.z, d.y);
    vec2 slope = two_sum(x.x, y.x);
    vec2 value = two_sum(slope.x, hi.x);
    vec2 sum = two_sum(value.x, (value.y + slope.y) + (x.y + y.y) + (lo.x + lo.y * d.x + lo.z * d.y));
    return on_tile(vec3(sum.x, hi.yz), vec3(sum.y, lo.yz));
}

// Affine map from the tile's pixels to kernel coordinates, σ along the ellipse's axes; remainders only with CONFETTI.
struct KernelMap {
    vec3 u, v;
    vec3 u_rest, v_rest;
};

KernelMap shuffle(KernelMap p, uint from) {
    KernelMap result = KernelMap(shuffle(p.u, from), shuffle(p.v, from), vec3(0.0), vec3(0.0));
    if (CONFETTI) {
        result.u_rest = shuffle(p.u_rest, from);
        result.v_rest = shuffle(p.v_rest, from);
    }
    return result;
}

vec2 value_at(KernelMap p, vec2 d) {
    if (CONFETTI) return vec2(value_at(Affine(p.u, p.u_rest), d), value_at(Affine(p.v, p.v_rest), d));
    return vec2(p.u.x + p.u.y * d.x + p.u.z * d.y, p.v.x + p.v.y * d.x + p.v.z * d.y);
}

// A splat with one of its variances, relative to the tile.
struct TileSplat {
    KernelMap kernel;
    Affine plane;
    float key_centre; // on_plane: κ of the plane at the centre
    float least_key;  // CURVATURES: see Ellipse
    float key_disc;
    vec3 lines[2];    // CLIPS: see ScreenClip
    float concave;
};

KernelMap kernel_map_on_tile(Ellipse ellipse, vec2 d) {
    if (CONFETTI) {
        Affine u = plane_on_tile(vec3(ellipse.fine[0].x, ellipse.whitening.xy), ellipse.fine[0].yzw, d);
        Affine v = plane_on_tile(vec3(ellipse.fine[1].x, ellipse.whitening.zw), ellipse.fine[1].yzw, d);
        return KernelMap(u.grid, v.grid, u.rest, v.rest);
    }
    vec2 at_origin = kernel_coordinates(ellipse, d);
    return KernelMap(vec3(at_origin.x, ellipse.whitening.xy), vec3(at_origin.y, ellipse.whitening.zw), vec3(0.0), vec3(0.0));
}

// Transforms an ellipse to the tile whose first pixel's centre is at `origin`, px.
TileSplat splat_on_tile(Ellipse ellipse, vec2 origin) {
    vec2 d = origin - ellipse.anchor;
    TileSplat splat;
    splat.kernel = kernel_map_on_tile(ellipse, d);
    splat.plane = plane_on_tile(ellipse.plane_hi, ellipse.plane_lo, d);
    splat.key_centre = ellipse.key_centre;
    splat.least_key = ellipse.least_key;
    splat.key_disc = ellipse.key_disc;
    splat.lines[0] = splat.lines[1] = vec3(1.0, 0.0, 0.0);
    splat.concave = 0.0;
    if (CLIPS && ellipse.clip != NO_CLIP) {
        ScreenClip clip = screen_clip(ellipse.clip);
        splat.lines[0] = vec3(clip.first.x + dot(clip.first.yz, d), clip.first.yz);
        splat.lines[1] = vec3(clip.second.x + dot(clip.second.yz, d), clip.second.yz);
        splat.concave = clip.first.w;
    }
    return splat;
}

TileSplat shuffle(TileSplat s, uint from) {
    TileSplat result = s;
    result.kernel = shuffle(s.kernel, from);
    result.plane = shuffle(s.plane, from);
    if (on_plane()) result.key_centre = shuffle(s.key_centre, from);
    if (CURVATURES) result.least_key = shuffle(s.least_key, from);
    result.key_disc = shuffle(s.key_disc, from);
    if (CLIPS) {
        result.lines[0] = shuffle(s.lines[0], from);
        result.lines[1] = shuffle(s.lines[1], from);
        result.concave = shuffle(s.concave, from);
    }
    return result;
}

// Signed distance, px, of a point d px from the tile's first pixel to the clip: see clip_distance.
float clip_distance(TileSplat splat, vec2 d) {
    float first = splat.lines[0].x + dot(splat.lines[0].yz, d), second = splat.lines[1].x + dot(splat.lines[1].yz, d);
    return splat.concave > 0.0 ? max(first, second) : min(first, second);
}

// Whether a splat has a fragment d px from the tile's first pixel: see splat_fragment.
bool tile_fragment(TileSplat splat, vec2 d, out vec2 m, out float key, out float rank) {
    m = value_at(splat.kernel, d);
    key = value_at(splat.plane, d);
    if (has_linear_depth()) key = world_key(key);
    if (on_plane()) m /= clamp(inverse_depth(key) / inverse_depth(splat.key_centre), 1.0 / MOST_STRETCH, MOST_STRETCH);
    bool inside =
        rim() > 1.0 ? max(abs(m.x), abs(m.y)) <= frame.cutoff : dot(m, m) <= frame.cutoff * frame.cutoff;
    rank = 1.0;
    if (CLIPS) rank = clip_rank(clip_distance(splat, d));
    if (CURVATURES) inside = inside && key >= splat.least_key;
    key = shown_key(key, splat.key_disc);
    return inside && rank > 0.0 && key > frame.key_far && key <= nearest_key();
}

// LIMITED_LOOPS: lavapipe stops all loops of an invocation after 65,535 iterations in total (LP_MAX_TGSI_LOOP_ITERATIONS), which would leave
// holes: each walk stops earlier, after its share. A walk visits some 30,000 visible splats per tile and dispatch; frames that may have more
// are SLICED. Loops within a step of a walk are unrolled, by [[unroll]] where the compiler would find them too long.

// Whether a walk stopped before it had visited all splats.
bool incomplete = false;

layout(set = 1, binding = 4, std430) writeonly buffer IncompleteFrame { uint incomplete_frame; };

// Whether all loops have been stopped: then a loop of two iterations ends after the first.
bool loops_are_stopped() {
    uint iterations = 0;
    [[dont_unroll]] do {
        iterations++;
    } while (iterations < 2);
    return iterations < 2;
}

// Writes the number of the frame if the tile lacks splats.
void report_incomplete() {
    if ((incomplete || loops_are_stopped()) && lane == 0) incomplete_frame = hierarchy.frame_number;
}

// Splats of a batch that are rasterized by unrolled code; a divisor of the least LANES.
const uint UNROLLED = 2;

// Depth keys of the lane's pixels, see lib/tile_visibility.glsl.
float depths[ROWS];

// Least depth key of the tile's visible pixels.
float least_depth() {
    float least = 1e30;
    for (uint r = 0; r < ROWS; r++) least = depths[r] > 0.0 ? min(least, depths[r]) : least;
    return workgroup_min(least);
}

// Index of a splat's screen clip in the frame, or NO_CLIP.
uint clip_of(uint id) {
    return CLIPS ? load_box(id).w : NO_CLIP;
}

// Ids of the splats that visibility visited on the tile, in order, up to MOST_VISITED; attribute rasterizes these. There is room for a
// batch and a block more. Walks that keep none use another part, from SCRATCH on.
const uint MOST_VISITED = 512, MOST_PENDING = 64 + 512, SCRATCH = MOST_VISITED + MOST_PENDING;
shared uint visited_ids[SCRATCH + MOST_PENDING];
uint visited_count;

uint lane_level_start;

// Cull key beyond all κ: further splats add nothing.
const float COMPLETE = 1e29;

// Level of blocks, whose nodes are visited near to far, and the most levels from it upwards.
const uint BLOCKS = 3, LEVELS = 7;

// Sorts the hit siblings near to far: returns a mask of as many low bits; `order` has the lane of each, 3 bits each.
uint sort_hits(bool hit, float nearest, out uint order) {
    float own_nearest = hit ? nearest : -1.0;
    uint rank = 0;
    for (uint k = 1; k < FAN_OUT; k++) {
        uint other = (lane + k) % FAN_OUT;
        float other_nearest = shuffle(own_nearest, other);
        rank += uint(other_nearest > own_nearest || other_nearest == own_nearest && other < lane);
    }
    order = hit ? lane << 3 * rank : 0;
    for (uint k = 0; k < 3; k++) order |= shuffle(order, lane ^ 1u << k);
    // Lanes beyond the siblings take the same order.
    if (LANES > FAN_OUT) order = shuffle(order, 0);
    return (1u << bitCount(workgroup_ballot(hit))) - 1u;
}

// Mask bits of a group of siblings on a level, counted from blocks.
uvec2 group_bits(uint bits, uint level) {
    return level < 4 ? uvec2(bits << FAN_OUT * level, 0) : uvec2(0, bits << FAN_OUT * (level - 4));
}

// Start of a level from 1 on: each lane holds the start of one, as dynamic indexing is slow.
uint level_start(uint level) {
    return shuffle(lane_level_start, level - 1);
}
