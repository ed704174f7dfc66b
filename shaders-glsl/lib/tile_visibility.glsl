// Visibility on a tile: κ of the nearest surface at each of the lane's pixels, moved back by ε, or as it is (ALONE); 0 where there is none.

#ifdef ALONE
uint winners[ROWS]; // the nearest splat
#endif

// The farthest depth of the team's pixels: what is behind it is hidden.
float farthest;

void update_farthest() {
    float least = depths[0];
    for (uint r = 1; r < ROWS; r++) least = min(least, depths[r]);
    farthest = team_min(least);
}

// Takes the splat `number`, if it is there.
void see(TileSplat splat, vec2 limit, uint number, bool is_splat) {
    for (uint r = 0; r < ROWS; r++) {
        vec2 m;
        float key, rank;
        bool there = tile_fragment(splat, vec2(lane_pixel(r)), m, key, rank) && is_splat;
#ifdef ALONE
        float depth = ranked(min(key, limit.x), rank);
        bool nearer = there && (depth > depths[r] || depth == depths[r] && number < winners[r]);
        depths[r] = nearer ? depth : depths[r];
        winners[r] = nearer ? number : winners[r];
#else
        float depth = ranked(visibility_key(key, limit.x, limit.y), rank);
        depths[r] = there ? max(depths[r], depth) : depths[r];
#endif
    }
}

void take_visibility(uint count, uint id, uvec2 low) {
    Splat splat = splat_of(id);
    vec2 variance = visibility_variance(variance_of(splat));
    TileSplat own = splat_on_tile(ellipse_of(splat, variance, clip_of(id)), vec2(low) + 0.5);
    vec2 limits = vec2(splat.key_disc, splat.epsilon);
    uint s = 0;
    do {
        // Several at a time: loops are bounded on lavapipe, and a splat alone keeps it waiting.
        for (uint k = 0; k < AT_A_TIME; k++) {
            see(of_lane(own, s + k), of_lane(limits, s + k), of_lane(id, s + k), s + k < count);
        }
        s += AT_A_TIME;
    } while (s < count);
    update_farthest();
}

#define WALK walk_visibility
#ifndef VISIBILITY_STEPS
#define VISIBILITY_STEPS 24000
#endif
#define WALK_STEPS VISIBILITY_STEPS
#define WALK_BEHIND farthest
#define WALK_KEEP
#define WALK_TAKE(count, id) take_visibility(count, id, low)
#include "lib/walk.glsl"

// From no surface, or from what an earlier dispatch has left in `depths`, and in `winners`.
void find_visible(uvec2 low) {
    // No pixel beside the picture waits for a surface.
    for (uint r = 0; r < ROWS; r++) {
        depths[r] = !is_on_picture(low + lane_pixel(r)) ? 1e30 : goes_on() ? depths[r] : 0.0;
#ifdef ALONE
        winners[r] = goes_on() ? winners[r] : 0;
#endif
    }
    update_farthest();
    met_count = 0;
    walk_visibility(low, low + TILE - 1);
}
