// A surfel as a point: where it is on the screen, and the sample that it is there.

#include "lib/double_float.glsl"
#include "lib/pixel_row.glsl"

layout(constant_id = 1) const bool CULL_BACK = false;
layout(constant_id = 12) const bool ELLIPSES = false;
layout(constant_id = 13) const bool TWO_SIDED = false;

layout(set = 0, binding = 4, std430) readonly buffer Radii { float radii[]; }; // negative where two-sided
layout(set = 0, binding = 8, std430) readonly buffer Ellipses { vec4 ellipses[]; };

// The pixel and the sample of surfel i; false where it is culled. The colour is left out.
bool point_of(uint i, out ivec2 at, out Sample s) {
    s = NOTHING;
    at = ivec2(-1);
    vec3 p = vec3(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    vec3 n = vec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
    float r = TWO_SIDED ? abs(radii[i]) : radii[i];
    if (!(r > 0.0)) return false;
    vec2 dx = two_sum(p.x, -frame.eye_hi.x), dy = two_sum(p.y, -frame.eye_hi.y), dz = two_sum(p.z, -frame.eye_hi.z);
    vec3 hi = vec3(dx.x, dy.x, dz.x), lo = vec3(dx.y, dy.y, dz.y) - frame.eye_lo.xyz;
    vec2 z = dot_double(hi, lo, frame.forward_hi.xyz, frame.forward_lo.xyz);
    vec2 w = PERSPECTIVE ? z : vec2(1.0, 0.0);
    float key = PERSPECTIVE ? frame.near / z.x : 1.0 - (z.x - frame.near) * frame.key_slope;
    if (!(z.x >= frame.near) || key < frame.key_far) return false;
    float facing = (PERSPECTIVE ? dot_double(hi, lo, n, vec3(0.0)) : dot_double(n, vec3(0.0), frame.forward_hi.xyz, frame.forward_lo.xyz)).x;
    bool culls = CULL_BACK && !(TWO_SIDED && radii[i] < 0.0);
    if (facing == 0.0 || culls && facing > 0.0) return false;

    vec2 x = pixel_row(0, hi, lo), y = pixel_row(1, hi, lo);
    if (PERSPECTIVE) w = pixel_row(2, hi, lo);
    at = ivec2(floor(vec2(x.x, y.x) / w.x));
    if (any(lessThan(at, ivec2(0))) || any(greaterThanEqual(at, ivec2(frame.viewport)))) return false;
    vec2 own = vec2(at) + 0.5;
    s.near = s.depth = z.x;
    // A disc of the ellipse's area.
    float radius = ELLIPSES ? r * sqrt(ellipses[i].w) : r;
    s.far = z.x + (PAPER ? 1.0 : 2.0) * radius;
    s.radius = focal_scale() * radius / (PERSPECTIVE ? z.x : 1.0);
    vec2 offset = vec2(add(x, scale(w, -own.x)).x, add(y, scale(w, -own.y)).x) / w.x;
    s.displacement = PAPER ? vec2(0.0) : offset;
    // Seen from behind, a disc is that of the opposite normal.
    s.normal = facing > 0.0 ? -n : n;
    s.tube = false;
    return true;
}
