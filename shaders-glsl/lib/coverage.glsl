// Coverage: which of 16 samples of each pixel lie on a surface, hidden or not: neighbouring splats together cover what none covers alone.

#include "lib/lattice.glsl"

const uint ALL_SAMPLES = (1u << SAMPLES) - 1;

// How much of a footprint is surface: discs are drawn 1.3 times as large as they need be to leave no holes.
const float SOLID = 0.77;
// Least variance of what is surface, px²: edge-on it has none.
const float LEAST_SOLID = 1e-12;
// What discs on either side of an edge share of it, px: more than rounding can part them by.
const float SEAM = 1.0 / 256.0;

uint nearest_sample(vec2 to) {
    uint nearest = 0;
    float least = 2.0;
    for (uint k = 0; k < SAMPLES; k++) {
        vec2 d = sample_at(k) - to;
        if (dot(d, d) < least) {
            least = dot(d, d);
            nearest = k;
        }
    }
    return nearest;
}

// The ellipse of a splat's own variance: filters widen what is seen of a surface, not the surface.
Ellipse solid_of(Splat splat, uint clip) {
    return ellipse_of(splat, max(variance_of(splat), LEAST_SOLID), clip);
}

// The samples that a splat covers at a pixel centre where it has a fragment; `solid` is its ellipse by solid_of.
uint coverage_mask(Ellipse solid, vec2 pixel) {
    vec2 d = pixel - solid.anchor;
    vec2 e = d - solid.offset;
    float limit = SOLID * frame.cutoff;
    vec3 nearness = vec3(1.0, 0.0, 0.0);
    if (on_plane()) nearness = vec3(plane_at(solid.plane_hi, solid.plane_lo, d), solid.plane_hi.yz) / solid.key_centre;
    uint mask = 0;
    for (uint k = 0; k < SAMPLES; k++) {
        vec2 s = sample_at(k);
        vec2 u = vec2(dot(solid.whitening.xy, e + s), dot(solid.whitening.zw, e + s));
        if (on_plane()) u /= clamp(nearness.x + dot(nearness.yz, s), 1.0 / MOST_STRETCH, MOST_STRETCH);
        bool inside = rim() > 1.0 ? max(abs(u.x), abs(u.y)) <= limit : dot(u, u) <= limit * limit;
        if (has_clip(solid.clip)) inside = inside && clip_distance(screen_clip(solid.clip), d + s) >= -SEAM;
        mask |= uint(inside) << k;
    }
    // Where a splat is, there is surface, however little.
    if (mask == 0 && max(abs(e.x), abs(e.y)) <= 0.5) mask = 1u << nearest_sample(-e);
    return mask;
}

#ifdef FRAGMENT
layout(set = 1, binding = 5, std430) buffer Coverage { uint coverage[]; }; // the 16 samples of each pixel, a bit each

// Adds what a splat covers at a pixel centre where it has a fragment.
void cover(uint index, Ellipse solid, vec2 pixel) {
    uint covered = coverage[index];
    if (covered == ALL_SAMPLES) return;
    uint mask = coverage_mask(solid, pixel);
    if ((mask & ~covered) != 0) atomicOr(coverage[index], mask);
}
#endif
