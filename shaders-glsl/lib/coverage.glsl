// Coverage: mask of the 16 samples of a pixel that lie on a surface, hidden or not: neighbouring splats together cover pixels that none
// covers alone.

#include "lib/lattice.glsl"

// Least variance of the solid ellipse, px²: an edge-on disc has none.
const float LEAST_SOLID = 1e-12;
// Overlap of discs on both sides of an edge, px: more than the rounding error between them.
const float SEAM = 1.0 / 256.0;

uint nearest_sample(vec2 position) {
    uint nearest = 0;
    float least = 2.0;
    for (uint k = 0; k < SAMPLES; k++) {
        vec2 d = sample_position(k) - position;
        if (dot(d, d) < least) {
            least = dot(d, d);
            nearest = k;
        }
    }
    return nearest;
}

// Solid ellipse of a splat, without low-pass filters: these widen the splat, not the surface.
Ellipse solid_ellipse(Splat splat, uint clip) {
    return ellipse_of(splat, max(variance_of(splat), LEAST_SOLID), clip);
}

// Mask of the samples that a splat covers at a pixel centre where it has a fragment; `solid` is its solid_ellipse, `least_key` its least_key.
uint coverage_mask(Ellipse solid, float least_key, vec2 pixel) {
    vec2 d = pixel - solid.anchor;
    vec2 e = d - solid.offset;
    float limit = SOLID * frame.cutoff;
    vec3 nearness = vec3(1.0, 0.0, 0.0);
    vec3 plane = vec3(0.0);
    if (on_plane() || CURVATURES) plane = vec3(plane_at(solid.plane_hi, solid.plane_lo, d), solid.plane_hi.yz);
    if (on_plane()) nearness = vec3(inverse_depth(plane.x), plane.yz) / inverse_depth(solid.key_centre);
    uint mask = 0;
    for (uint k = 0; k < SAMPLES; k++) {
        vec2 s = sample_position(k);
        vec2 u = vec2(dot(solid.whitening.xy, e + s), dot(solid.whitening.zw, e + s));
        if (on_plane()) u /= clamp(nearness.x + dot(nearness.yz, s), 1.0 / MOST_STRETCH, MOST_STRETCH);
        bool inside = rim() > 1.0 ? max(abs(u.x), abs(u.y)) <= limit : dot(u, u) <= limit * limit;
        if (CURVATURES) inside = inside && plane.x - least_key + dot(plane.yz, s) >= 0.0;
        if (has_clip(solid.clip)) inside = inside && clip_distance(screen_clip(solid.clip), d + s) >= -SEAM;
        mask |= uint(inside) << k;
    }
    // A splat covers at least one sample of the pixel that contains its centre.
    if (mask == 0 && max(abs(e.x), abs(e.y)) <= 0.5) mask = 1u << nearest_sample(-e);
    return mask;
}

#ifdef FRAGMENT
layout(set = 1, binding = 5, std430) buffer Coverage { uint coverage[]; }; // the 16 samples of each pixel, one bit each
#endif
