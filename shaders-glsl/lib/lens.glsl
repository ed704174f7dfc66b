// From pixels to rays, and the ellipse that a disc is on the screen.

layout(constant_id = 28) const bool PAPER = false; // as published

// px of a unit length across the view, at distance 1 in perspective.
float focal_scale() {
    return sqrt(view.jacobian);
}

// Step of the ray through a pixel position for one unit of distance.
vec3 ray_step(vec2 at) {
    if (!PERSPECTIVE) return view.forward_hi.xyz;
    return (at.x * view.ray_hi[0].xyz + at.y * view.ray_hi[1].xyz + view.ray_hi[2].xyz) / view.near;
}

vec2 across(vec3 v) {
    return vec2(dot(view.flat_rows[0].xyz, v), dot(view.flat_rows[1].xyz, v));
}

// Unit vector from the surface at a pixel position to the eye.
vec3 to_eye_at(vec2 at) {
    return -normalize(ray_step(at));
}

// Normal of the disc about a centre on the screen: a tube's faces the eye.
vec3 disc_normal(Sample s, vec2 centre) {
    return s.tube ? to_eye_at(centre) : s.normal;
}

// Squared distance from a disc's centre, in its radii, of what is e px from it: its image to first order about its centre, its variance
// widened by h, px².
float radii2(Sample s, vec2 centre, vec2 e, float h) {
    vec3 normal = disc_normal(s, centre);
    if (PAPER) {
        // By parallel projection, with a minor semi-axis of half a pixel at least.
        vec2 flat_normal = across(normal) / focal_scale();
        float size = length(flat_normal);
        vec2 along = size > 0.0 ? flat_normal / size : vec2(1.0, 0.0);
        float minor = max(s.radius * abs(dot(normal, view.forward_hi.xyz)), 0.5);
        vec2 m = vec2(dot(along, e) / minor, (along.x * e.y - along.y * e.x) / max(s.radius, 0.5));
        return dot(m, m);
    }
    vec3 step = ray_step(centre);
    vec2 a = across(step), lean = across(normal - step * dot(normal, view.forward_hi.xyz));
    vec3 x = view.flat_rows[0].xyz, y = view.flat_rows[1].xyz;
    vec3 seen = vec3(dot(x, x), dot(x, y), dot(y, y)) + vec3(a.x * a.x, a.x * a.y, a.y * a.y) -
                vec3(lean.x * lean.x, lean.x * lean.y, lean.y * lean.y);
    float radius2 = s.radius * s.radius;
    vec3 v = radius2 / view.jacobian * seen + vec3(h, 0.0, h);
    // The determinant by its closed form: as a difference it would be lost on a disc seen edge-on.
    float facing = radius2 * dot(normal, step);
    float determinant = facing * facing + h * (v.x + v.z - h);
    return (v.z * e.x * e.x - 2.0 * v.y * e.x * e.y + v.x * e.y * e.y) / determinant;
}

// Distance at which the ray through what is e px from a disc's centre meets its plane, no further from its own than its radius.
float depth_at(Sample s, vec2 centre, vec2 e) {
    float from = dot(s.normal, ray_step(centre)), met;
    if (PERSPECTIVE) {
        float rise = dot(s.normal, view.ray_hi[0].xyz * e.x + view.ray_hi[1].xyz * e.y) / view.near;
        met = s.depth * from / (from + rise);
        // Beyond the plane's horizon it is as far as it may be.
        if (!(met > 0.0)) met = 1e38;
    } else {
        met = s.depth - dot(s.normal, view.ray_hi[0].xyz * e.x + view.ray_hi[1].xyz * e.y) / (view.key_slope * from);
    }
    float reach = s.radius / focal_scale() * (PERSPECTIVE ? s.depth : 1.0);
    return clamp(met, s.depth - reach, s.depth + reach);
}

// Radius below which a tube is as round as one of it, px: a pixel that holds all of a hair is not its rim.
const float THIN = 1.0;
// Squared sine of the angle to its axis below which a tube is seen from its end.
const float END_ON = 1e-4;

// Where the ray through `at`, e px from where a tube's axis is seen, meets it: the distance, no further from the axis's than twice the
// radius, which is as far as it goes up to 60° from the picture's plane. The normal is that there, or of the outline beyond it.
float on_tube(Sample s, vec2 at, vec2 e, out vec3 normal) {
    vec3 tangent = s.normal, to_eye = to_eye_at(at);
    float radius = max(s.radius, THIN) / focal_scale() * (PERSPECTIVE ? s.depth : 1.0);
    // From the axis to the ray, at the axis's distance.
    float reach = PERSPECTIVE ? s.depth / view.near : 1.0 / view.key_slope;
    vec3 offset = reach * (view.ray_hi[0].xyz * e.x + view.ray_hi[1].xyz * e.y);
    offset -= dot(offset, tangent) * tangent;
    vec3 eye = to_eye - dot(to_eye, tangent) * tangent;
    float slope = dot(eye, eye);
    // Along the axis it has no side: it is the ball about its end.
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
