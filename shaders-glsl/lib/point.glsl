// Surfels as points of one pixel.

#include "lib/cull_reasons.glsl"
#include "lib/double_float.glsl"
#include "lib/levels.glsl"
#include "lib/pixel_row.glsl"

layout(constant_id = 1) const bool CULL_BACK = false;

struct Point {
    ivec2 pixel;  // the pixel that contains it
    vec2 offset;  // from that pixel's centre, px
    float distance;
    float facing; // above 0 if seen from behind
};

// Integer part of x / w, two values of twice the precision, and the remainder, for positions in the viewport. The rounded quotient may
// cross a pixel border: the remainder corrects it.
float integer_part(vec2 x, vec2 w, out float fraction) {
    float integer = floor(x.x / w.x);
    vec2 remainder = add(x, scale(w, -integer));
    if (remainder.x < 0.0) {
        integer -= 1.0;
        remainder = add(remainder, w);
    } else if (add(remainder, -w).x >= 0.0) {
        integer += 1.0;
        remainder = add(remainder, -w);
    }
    fraction = remainder.x / w.x;
    return integer;
}

// Projects surfel i to a point; returns its cull reason.
uint point_of(uint i, out Point point) {
    point = Point(ivec2(-1), vec2(0.0), 0.0, 0.0);
    if (!is_valid(i)) return INVALID;
    vec3 p = position_of(i), n = normal_of(i);
    if (HAS_LEVELS && !is_of_drawn_level(chunk.first_id + i, p)) return LEVEL;
    vec2 dx = two_sum(p.x, -view.eye_hi.x), dy = two_sum(p.y, -view.eye_hi.y), dz = two_sum(p.z, -view.eye_hi.z);
    vec3 hi = vec3(dx.x, dy.x, dz.x), lo = vec3(dx.y, dy.y, dz.y) - view.eye_lo.xyz;
    float z = counted_distance(dot_double(hi, lo, view.forward_hi.xyz, view.forward_lo.xyz)).x;
    // Here and below, values may be NaN where positions are too large for the view.
    if (!is_number(z) || z < view.near || z <= 0.0) return BEHIND;
    if (key_at_distance(z) < frame.key_far) return BEHIND;
    point.distance = z;
    point.facing = (PERSPECTIVE ? dot_double(hi, lo, n, vec3(0.0)) : dot_double(n, vec3(0.0), view.forward_hi.xyz, view.forward_lo.xyz)).x;
    if (CULL_BACK && !is_two_sided(i) && point.facing >= 0.0) return BACK;
    if (point.facing == 0.0) return OUTSIDE;

    vec2 w = PERSPECTIVE ? pixel_row(2, hi, lo) : vec2(1.0, 0.0);
    vec2 fraction, corner;
    corner.x = integer_part(pixel_row(0, hi, lo), w, fraction.x);
    corner.y = integer_part(pixel_row(1, hi, lo), w, fraction.y);
    bool inside = are_numbers(corner.xyxy) && all(greaterThanEqual(corner, vec2(0.0))) && all(lessThan(corner, frame.viewport));
    if (!inside) return OUTSIDE;
    point.pixel = ivec2(corner);
    point.offset = fraction - 0.5;
    return DRAWN;
}
