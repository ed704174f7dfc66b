// Rays of pixels, and the projection of discs, for pull–push.

#include "lib/flat_pixel.glsl"
#include "lib/ray_step.glsl"

layout(constant_id = 28) const bool PAPER = false; // rules as published

// Projected size of a unit length parallel to the image plane, px; at distance 1 in perspective.
float focal_scale() {
    return sqrt(view.jacobian);
}

// Unit vector from the surface at a screen position to the eye.
vec3 to_eye_at(vec2 at) {
    return -normalize(ray_step(at));
}

// Normal of a sample's disc with this centre on the screen: the disc of a tube faces the eye.
vec3 disc_normal(Sample s, vec2 centre) {
    return s.tube ? to_eye_at(centre) : s.normal;
}

// Squared distance, in squared radii, of a point e px from a disc's centre: the disc's image to first order around its centre, its variance
// widened by h, px².
float radii2(Sample s, vec2 centre, vec2 e, float h) {
    vec3 normal = disc_normal(s, centre);
    if (PAPER) {
        // By parallel projection, with a minor semi-axis of at least half a pixel.
        vec2 flat_normal = flat_pixel(normal) / focal_scale();
        float size = length(flat_normal);
        vec2 along = size > 0.0 ? flat_normal / size : vec2(1.0, 0.0);
        float minor = max(s.radius * abs(dot(normal, view.forward_hi.xyz)), 0.5);
        vec2 m = vec2(dot(along, e) / minor, (along.x * e.y - along.y * e.x) / max(s.radius, 0.5));
        return dot(m, m);
    }
    vec3 step = ray_step(centre);
    vec2 a = flat_pixel(step), lean = flat_pixel(normal - step * dot(normal, view.forward_hi.xyz));
    vec3 x = view.flat_rows[0].xyz, y = view.flat_rows[1].xyz;
    vec3 image = vec3(dot(x, x), dot(x, y), dot(y, y)) + vec3(a.x * a.x, a.x * a.y, a.y * a.y) -
                vec3(lean.x * lean.x, lean.x * lean.y, lean.y * lean.y);
    float radius2 = s.radius * s.radius;
    vec3 v = radius2 / view.jacobian * image + vec3(h, 0.0, h);
    // The determinant by its closed form: a difference would cancel for an edge-on disc.
    float facing = radius2 * dot(normal, step);
    float determinant = facing * facing + h * (v.x + v.z - h);
    return (v.z * e.x * e.x - 2.0 * v.y * e.x * e.y + v.x * e.y * e.y) / determinant;
}

// Distance at which the ray e px from a disc's centre meets its plane, clamped to the centre's distance ± the radius.
float depth_at(Sample s, vec2 centre, vec2 e) {
    float from = dot(s.normal, ray_step(centre)), hit;
    if (PERSPECTIVE) {
        float rise = dot(s.normal, view.ray_hi[0].xyz * e.x + view.ray_hi[1].xyz * e.y) / view.near;
        hit = DISTANT ? s.depth - from_eye(s.depth) * (rise / (from + rise)) : s.depth * from / (from + rise);
        // Beyond the plane's horizon: the greatest distance.
        if (!(from_eye(hit) > 0.0)) hit = 1e38;
    } else {
        hit = s.depth - dot(s.normal, view.ray_hi[0].xyz * e.x + view.ray_hi[1].xyz * e.y) / (view.key_slope * from);
    }
    float reach = s.radius / focal_scale() * (PERSPECTIVE ? from_eye(s.depth) : 1.0);
    return clamp(hit, s.depth - reach, s.depth + reach);
}

// Least radius for a tube's shading, px: all pixels of a thinner hair would be rim.
const float THIN = 1.0;
// Squared sine of the angle between ray and axis below which a tube is seen end-on.
const float END_ON = 1e-4;

// Distance at which the ray through a pixel, e px from the projected axis, meets a tube, clamped to the axis's distance ± twice the radius:
// enough up to 60° from the image plane. The normal is that of the point, or of the outline for rays that miss.
float on_tube(Sample s, vec2 at, vec2 e, out vec3 normal) {
    vec3 tangent = s.normal, to_eye = to_eye_at(at);
    float radius = max(s.radius, THIN) / focal_scale() * (PERSPECTIVE ? from_eye(s.depth) : 1.0);
    // From the axis to the ray, at the axis's distance.
    float reach = PERSPECTIVE ? from_eye(s.depth) / view.near : 1.0 / view.key_slope;
    vec3 offset = reach * (view.ray_hi[0].xyz * e.x + view.ray_hi[1].xyz * e.y);
    offset -= dot(offset, tangent) * tangent;
    vec3 eye = to_eye - dot(to_eye, tangent) * tangent;
    float slope = dot(eye, eye);
    // End-on, the tube is the ball around its end.
    normal = to_eye;
    if (slope < END_ON) return s.depth - radius;
    float middle = -dot(offset, eye) / slope;
    vec3 nearest = offset + middle * eye;
    float reached = middle + sqrt(max((radius * radius - dot(nearest, nearest)) / slope, 0.0));
    vec3 out_of = offset + reached * eye;
    if (dot(out_of, out_of) > 0.0) normal = normalize(out_of);
    float rise = -reached * dot(to_eye, view.forward_hi.xyz);
    return s.depth - clamp(rise, -2.0 * radius, 2.0 * radius);
}
