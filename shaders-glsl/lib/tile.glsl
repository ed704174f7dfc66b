// A tile: TILE × TILE px that a team rasterizes splats to. Each lane has a column's pixels, ROW_STEP apart, in registers.

#define BOX_ACCESS readonly
#include "lib/box.glsl"
#include "lib/team.glsl"

// Where the levels of the hierarchy of boxes begin: level 0 is of splats, a node of level 3 is a block of 512.
layout(push_constant) uniform Hierarchy {
    uint starts[10];
    uint attribute_rows; // of a splat
    // The splats of the dispatch: those below a group of siblings. Where SLICED there are several dispatches, and each goes on where the one
    // before ended; they are numbered from 0 on.
    uint level;
    uint group;
    uint slice;
    uint slices;
} hierarchy;

layout(constant_id = 47) const bool SLICED = false;

// Whether this dispatch goes on where another ended, and whether another goes on where this one ends.
bool goes_on() {
    return SLICED && hierarchy.slice > 0;
}

bool is_last() {
    return !SLICED || hierarchy.slice + 1 == hierarchy.slices;
}

const uint TILE = 8;
const uint ROWS = TILE * TILE / LANES;
const uint ROW_STEP = LANES / TILE;

// The tile of this team: even rows of tiles first, then odd ones, so that devices that deal workgroups out in halves deal the picture evenly.
uvec2 tile_low() {
    uint half_way = (gl_NumWorkGroups.y + 1) / 2, y = gl_WorkGroupID.y;
    return TILE * uvec2(gl_WorkGroupID.x, y < half_way ? 2 * y : 2 * (y - half_way) + 1);
}

// The lane's first pixel, and its row-th one, relative to the tile.
uvec2 lane_pixel(uint row) {
    return uvec2(lane % TILE, lane / TILE + ROW_STEP * row);
}

bool is_on_picture(uvec2 pixel) {
    return all(lessThan(pixel, uvec2(frame.viewport)));
}

// An affine function on the tile, which is evaluated without rounding but for what is left over, however large its terms are: its value at the
// tile's first pixel and its derivatives along x and y, per px, on a grid so coarse that their sums are exact, and what that grid lacks.
struct Affine {
    vec3 grid;
    vec3 rest;
};

Affine on_tile(vec3 hi, vec3 lo) {
    vec3 size = abs(hi) * vec3(1.0, TILE, TILE);
    float most = min(max(size.x, max(size.y, size.z)), 1e30);
    // Grid of 2⁻¹⁸ of the power of two below `most`: sums stay below 2²⁴ of it.
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

Affine of_lane(Affine f, uint from) {
    return Affine(of_lane(f.grid, from), of_lane(f.rest, from));
}

// The plane's value at d px from the anchor as the sum of two floats, and its derivatives: see plane_at.
Affine plane_on_tile(vec3 hi, vec3 lo, vec2 d) {
    vec2 x = two_product(hi.y, d.x), y = two_product(hi.z, d.y);
    vec2 slope = two_sum(x.x, y.x);
    vec2 value = two_sum(slope.x, hi.x);
    vec2 sum = two_sum(value.x, (value.y + slope.y) + (x.y + y.y) + (lo.x + lo.y * d.x + lo.z * d.y));
    return on_tile(vec3(sum.x, hi.yz), vec3(sum.y, lo.yz));
}

// The place in a kernel on the tile: σ along the ellipse's axes. CONFETTI alone has need of what is left over.
struct Place {
    vec3 u, v;
    vec3 u_rest, v_rest;
};

Place of_lane(Place p, uint from) {
    Place own = Place(of_lane(p.u, from), of_lane(p.v, from), vec3(0.0), vec3(0.0));
    if (CONFETTI) {
        own.u_rest = of_lane(p.u_rest, from);
        own.v_rest = of_lane(p.v_rest, from);
    }
    return own;
}

vec2 value_at(Place p, vec2 d) {
    if (CONFETTI) return vec2(value_at(Affine(p.u, p.u_rest), d), value_at(Affine(p.v, p.v_rest), d));
    return vec2(p.u.x + p.u.y * d.x + p.u.z * d.y, p.v.x + p.v.y * d.x + p.v.z * d.y);
}

// A splat of one variance on the tile.
struct TileSplat {
    Place place;
    Affine plane;
    float key_centre; // on_plane: κ of the plane at the centre
    vec3 lines[2];    // CLIPS: see ScreenClip
    float concave;
};

Place place_on_tile(Ellipse ellipse, vec2 d) {
    if (CONFETTI) {
        Affine u = plane_on_tile(vec3(ellipse.fine[0].x, ellipse.whitening.xy), ellipse.fine[0].yzw, d);
        Affine v = plane_on_tile(vec3(ellipse.fine[1].x, ellipse.whitening.zw), ellipse.fine[1].yzw, d);
        return Place(u.grid, v.grid, u.rest, v.rest);
    }
    vec2 at = place(ellipse, d);
    return Place(vec3(at.x, ellipse.whitening.xy), vec3(at.y, ellipse.whitening.zw), vec3(0.0), vec3(0.0));
}

// A splat's ellipse at the tile whose first pixel's centre is at `origin`, px.
TileSplat splat_on_tile(Ellipse ellipse, vec2 origin) {
    vec2 d = origin - ellipse.anchor;
    TileSplat splat;
    splat.place = place_on_tile(ellipse, d);
    splat.plane = plane_on_tile(ellipse.plane_hi, ellipse.plane_lo, d);
    splat.key_centre = ellipse.key_centre;
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

TileSplat of_lane(TileSplat s, uint from) {
    TileSplat own = s;
    own.place = of_lane(s.place, from);
    own.plane = of_lane(s.plane, from);
    if (on_plane()) own.key_centre = of_lane(s.key_centre, from);
    if (CLIPS) {
        own.lines[0] = of_lane(s.lines[0], from);
        own.lines[1] = of_lane(s.lines[1], from);
        own.concave = of_lane(s.concave, from);
    }
    return own;
}

// Signed distance, px, of what is d px from the tile's first pixel to what is clipped: see clip_distance.
float clip_distance(TileSplat splat, vec2 d) {
    float first = splat.lines[0].x + dot(splat.lines[0].yz, d), second = splat.lines[1].x + dot(splat.lines[1].yz, d);
    return splat.concave > 0.0 ? max(first, second) : min(first, second);
}

// Whether a splat has a fragment d px from the tile's first pixel: see splat_fragment.
bool tile_fragment(TileSplat splat, vec2 d, out vec2 m, out float key, out float rank) {
    m = value_at(splat.place, d);
    key = value_at(splat.plane, d);
    if (has_linear_depth()) key = key > 0.0 ? frame.near / key : 2.0;
    if (on_plane()) m /= clamp(key / splat.key_centre, 1.0 / MOST_STRETCH, MOST_STRETCH);
    bool inside =
        rim() > 1.0 ? max(abs(m.x), abs(m.y)) <= frame.cutoff : dot(m, m) <= frame.cutoff * frame.cutoff;
    rank = 1.0;
    if (CLIPS) rank = clip_rank(clip_distance(splat, d));
    return inside && rank > 0.0 && key > frame.key_far && key <= 1.0;
}

// The values of the lanes in `wanted`, moved together to the lanes from 0 on: each moves down by as many as are not wanted below it, by powers of
// two in turn.
uint compacted(uint value, uint wanted) {
    uint moves = bitCount(~wanted & ((1u << lane) - 1u));
    moves = (wanted >> lane & 1u) != 0 ? moves : 0;
    for (uint k = 0; k < STEPS; k++) {
        uint step = 1u << k;
        uint from = min(lane + step, LANES - 1);
        uint next_moves = of_lane(moves, from), next_value = of_lane(value, from);
        bool comes = (next_moves & step) != 0 && lane + step < LANES;
        value = comes ? next_value : value;
        moves = comes ? next_moves : (moves & step) != 0 ? 0 : moves;
    }
    return value;
}

// lavapipe ends all loops of an invocation after 65,535 steps together (LP_MAX_TGSI_LOOP_ITERATIONS), which would leave a hole: walks end before,
// each after its part of them. Some 30,000 splats that are not hidden have their turn on a tile in a dispatch; frames in which there may be more
// are SLICED.

// Splats of a batch that are rasterized without a loop; a divisor of the least team's size.
const uint AT_A_TIME = 2;

// The lane's depths, see lib/tile_visibility.glsl.
float depths[ROWS];

// Where the frame has the clip of a splat on the screen, or NO_CLIP.
uint clip_of(uint id) {
    return CLIPS ? load_box(id).w : NO_CLIP;
}

// The splats that visibility met on the tile, in the order of its walk, as far as there is room for them; attributes take them from here.
const uint MOST_MET = 512;
shared uint met_list[MOST_MET + 64];
uint met_count;

uint own_start;

// The level of blocks: nodes that are walked near to far, and above which there are at most so many levels, their own included.
const uint BLOCKS = 3, LEVELS = 7;

// The lanes that are `wanted`, as bits from 0 on by their turn, near to far; `order` has the lane of each turn, 3 bits each.
uint turns_of(bool wanted, float nearest, out uint order) {
    float own = wanted ? nearest : -1.0;
    uint turn = 0;
    for (uint k = 1; k < FAN_OUT; k++) {
        uint other = (lane + k) % FAN_OUT;
        float its = of_lane(own, other);
        turn += uint(its > own || its == own && other < lane);
    }
    order = wanted ? lane << 3 * turn : 0;
    for (uint k = 0; k < 3; k++) order |= of_lane(order, lane ^ 1u << k);
    // Lanes beyond the siblings go the same way.
    if (LANES > FAN_OUT) order = of_lane(order, 0);
    return (1u << bitCount(team_ballot(wanted))) - 1u;
}

// Bits of a group of siblings on a level from blocks up.
uvec2 group_bits(uint bits, uint level) {
    return level < 4 ? uvec2(bits << FAN_OUT * level, 0) : uvec2(0, bits << FAN_OUT * (level - 4));
}

// Where a level from 1 on begins: each lane has the start of one, as loads by number would be slow.
uint level_start(uint level) {
    return of_lane(own_start, level - 1);
}
