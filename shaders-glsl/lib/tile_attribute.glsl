// Attributes on a tile: weighted sums, at each of the lane's pixels, over the splats that are not behind its depth. Splats come in their order, so
// that sums are the same in every frame.

#include "lib/attributes.glsl"
#include "lib/weights.glsl"

vec4 tile_sums0[ROWS], tile_sums1[ROWS]; // see lib/sums.glsl

// What hides everything behind it.
float hidden_behind;

// Adds a splat, if it is one: `first` is (normal or colour, weight).
void add(TileSplat splat, vec4 first, vec3 second, vec4 corners, vec3 square, bool is_splat) {
    mat2 axes = mat2(square.xy, square.z * vec2(-square.y, square.x));
    for (uint r = 0; r < ROWS; r++) {
        vec2 m;
        float key, rank;
        bool there = tile_fragment(splat, vec2(lane_pixel(r)), m, key, rank) && is_splat;
        // Where visibility found nothing there is no surface, whatever the wider footprint says.
        there = there && depths[r] > 0.0 && ranked(key, rank) >= depths[r];
        float weight = first.w;
        if (!OVERLAP) weight *= kernel(dot(m, m));
        if (FRAME_CORNERS && !OVERLAP) weight *= weight_in(corners, axes, m);
        weight = there ? weight : 0.0;
        tile_sums0[r] += vec4(weight, weight * first.xyz);
        tile_sums1[r] += vec4(there ? weight * frame.key_gain * key : 0.0, weight * second);
    }
}

void take_attribute(uint count, uint id, uvec2 low) {
    Splat splat = splat_of(id);
    vec2 variance = attribute_variance(variance_of(splat));
    TileSplat own = splat_on_tile(ellipse_of(splat, variance, clip_of(id)), vec2(low) + 0.5);
    Attributes attributes = attributes_of(id);
    vec4 first = vec4(attributes.first, OVERLAP ? 1.0 : attributes.weight * amplitude_of(splat, variance));
    // What no splat has may be no number, which 0 times is none either.
    first = lane < count ? first : vec4(0.0);
    attributes.second = lane < count ? attributes.second : vec3(0.0);
    uint s = 0;
    do {
        for (uint k = 0; k < AT_A_TIME; k++) {
            vec3 second = WIDE_SUMS1 ? of_lane(attributes.second, s + k) : vec3(0.0);
            vec4 corners = FRAME_CORNERS ? of_lane(attributes.corners, s + k) : vec4(1.0);
            vec3 square = FRAME_CORNERS ? of_lane(attributes.square, s + k) : vec3(1.0);
            add(of_lane(own, s + k), of_lane(first, s + k), second, corners, square, s + k < count);
        }
        s += AT_A_TIME;
    } while (s < count);
}

#define WALK walk_attribute
#ifndef ATTRIBUTE_STEPS
#define ATTRIBUTE_STEPS 26000
#endif
#define WALK_STEPS ATTRIBUTE_STEPS
#define WALK_BEHIND hidden_behind
#define WALK_TAKE(count, id) take_attribute(count, id, low)
#include "lib/walk.glsl"

// `depths` are those of visibility.
void sum_attributes(uvec2 low) {
    float least = 1e30;
    for (uint r = 0; r < ROWS; r++) {
        if (!goes_on()) tile_sums0[r] = tile_sums1[r] = vec4(0.0);
        if (depths[r] > 0.0 && is_on_picture(low + lane_pixel(r))) least = min(least, depths[r]);
    }
    // Not what is as near as the farthest: it counts.
    hidden_behind = 0.999999 * team_min(least);
    TEAM_BARRIER();
    bool all_kept = met_count <= MOST_MET;
    uint taken = 0, kept = all_kept ? met_count : 0;
    do {
        uint count = min(kept - taken, LANES);
        uint id = lane < count ? met_list[taken + lane] : 0;
        take_attribute(count, id, low);
        taken += count;
    } while (taken < kept);
    hidden_behind = all_kept ? 1e30 : hidden_behind;
    walk_attribute(low, low + TILE - 1);
}
