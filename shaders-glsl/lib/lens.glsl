// From pixels to rays, and the ellipse that a disc is on the screen.

layout(constant_id = 28) const bool PAPER = false; // as published

// px of a unit length across the view, at distance 1 in perspective.
float focal_scale() {
    return sqrt(frame.jacobian);
}

// Step of the ray through a pixel position for one unit of distance.
vec3 ray_step(vec2 at) {
    if (!PERSPECTIVE) return frame.forward_hi.xyz;
    return (at.x * frame.ray_hi[0].xyz + at.y * frame.ray_hi[1].xyz + frame.ray_hi[2].xyz) / frame.near;
}

vec2 across(vec3 v) {
    return vec2(dot(frame.flat_rows[0].xyz, v), dot(frame.flat_rows[1].xyz, v));
}

// Squared distance from a disc's centre, in its radii, of what is e px from it: its image to first order about its centre, its variance
// widened by h, px².
float radii2(Sample s, vec2 centre, vec2 e, float h) {
    if (PAPER) {
        // By parallel projection, with a minor semi-axis of half a pixel at least.
        vec2 flat_normal = across(s.normal) / focal_scale();
        float size = length(flat_normal);
        vec2 along = size > 0.0 ? flat_normal / size : vec2(1.0, 0.0);
        float minor = max(s.radius * abs(dot(s.normal, frame.forward_hi.xyz)), 0.5);
        vec2 m = vec2(dot(along, e) / minor, (along.x * e.y - along.y * e.x) / max(s.radius, 0.5));
        return dot(m, m);
    }
    vec3 step = ray_step(centre);
    vec2 a = across(step), lean = across(s.normal - step * dot(s.normal, frame.forward_hi.xyz));
    vec3 x = frame.flat_rows[0].xyz, y = frame.flat_rows[1].xyz;
    vec3 seen = vec3(dot(x, x), dot(x, y), dot(y, y)) + vec3(a.x * a.x, a.x * a.y, a.y * a.y) -
                vec3(lean.x * lean.x, lean.x * lean.y, lean.y * lean.y);
    float radius2 = s.radius * s.radius;
    vec3 v = radius2 / frame.jacobian * seen + vec3(h, 0.0, h);
    // The determinant by its closed form: as a difference it would be lost on a disc seen edge-on.
    float facing = radius2 * dot(s.normal, step);
    float determinant = facing * facing + h * (v.x + v.z - h);
    return (v.z * e.x * e.x - 2.0 * v.y * e.x * e.y + v.x * e.y * e.y) / determinant;
}

// Distance at which the ray through what is e px from a disc's centre meets its plane, no further from its own than its radius.
float depth_at(Sample s, vec2 centre, vec2 e) {
    float from = dot(s.normal, ray_step(centre)), met;
    if (PERSPECTIVE) {
        float rise = dot(s.normal, frame.ray_hi[0].xyz * e.x + frame.ray_hi[1].xyz * e.y) / frame.near;
        met = s.depth * from / (from + rise);
        // Beyond the plane's horizon it is as far as it may be.
        if (!(met > 0.0)) met = 1e38;
    } else {
        met = s.depth - dot(s.normal, frame.ray_hi[0].xyz * e.x + frame.ray_hi[1].xyz * e.y) / (frame.key_slope * from);
    }
    float reach = s.radius / focal_scale() * (PERSPECTIVE ? s.depth : 1.0);
    return clamp(met, s.depth - reach, s.depth + reach);
}
