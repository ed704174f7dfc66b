// A surfel as a point of one pixel.

#include "lib/cull_reasons.glsl"
#include "lib/double_float.glsl"
#include "lib/pixel_row.glsl"

layout(constant_id = 1) const bool CULL_BACK = false;

struct Point {
    ivec2 at;       // the pixel that holds it
    vec2 offset;    // from that pixel's centre, px
    float distance;
    float facing;   // above 0 where it is seen from behind
};

// The whole part of x / w, two values of twice the precision, and what is left of it; for positions on the picture. The quotient of floats
// may be rounded beyond a border: what is left tells.
float whole_part(vec2 x, vec2 w, out float rest) {
    float whole = floor(x.x / w.x);
    vec2 left = add(x, scale(w, -whole));
    if (left.x < 0.0) {
        whole -= 1.0;
        left = add(left, w);
    } else if (add(left, -w).x >= 0.0) {
        whole += 1.0;
        left = add(left, -w);
    }
    rest = left.x / w.x;
    return whole;
}

// Where surfel i is, and what becomes of it.
uint point_of(uint i, out Point point) {
    point = Point(ivec2(-1), vec2(0.0), 0.0, 0.0);
    if (!is_valid(i)) return INVALID;
    vec3 p = position_of(i), n = normal_of(i);
    vec2 dx = two_sum(p.x, -view.eye_hi.x), dy = two_sum(p.y, -view.eye_hi.y), dz = two_sum(p.z, -view.eye_hi.z);
    vec3 hi = vec3(dx.x, dy.x, dz.x), lo = vec3(dx.y, dy.y, dz.y) - view.eye_lo.xyz;
    float z = dot_double(hi, lo, view.forward_hi.xyz, view.forward_lo.xyz).x;
    // Tests are such that a coordinate which is no number fails them.
    if (!(z >= view.near && z > 0.0)) return BEHIND;
    if ((PERSPECTIVE ? view.near / z : 1.0 - (z - view.near) * view.key_slope) < frame.key_far) return BEHIND;
    point.distance = z;
    point.facing = (PERSPECTIVE ? dot_double(hi, lo, n, vec3(0.0)) : dot_double(n, vec3(0.0), view.forward_hi.xyz, view.forward_lo.xyz)).x;
    if (CULL_BACK && !is_two_sided(i) && point.facing >= 0.0) return BACK;
    if (point.facing == 0.0) return OUTSIDE;

    vec2 w = PERSPECTIVE ? pixel_row(2, hi, lo) : vec2(1.0, 0.0);
    vec2 rest, corner;
    corner.x = whole_part(pixel_row(0, hi, lo), w, rest.x);
    corner.y = whole_part(pixel_row(1, hi, lo), w, rest.y);
    if (!(all(greaterThanEqual(corner, vec2(0.0))) && all(lessThan(corner, frame.viewport)))) return OUTSIDE;
    point.at = ivec2(corner);
    point.offset = rest - 0.5;
    return DRAWN;
}
