// A triangle as points: the pixels whose centres it contains, those on its edges included (marroquim2008 §5.1). Edges are planes through
// the eye, so parts behind it need no clipping.

struct Triangle {
    uint corners[3];
    Vertex a, b, c;
    vec2 anchor;    // a pixel corner near the triangle, px
    vec2 screen[3]; // of the vertices, relative to the anchor, px
};

vec2 from_anchor(Vertex v, vec2 anchor) {
    vec2 x = pixel_row(0, v.hi, v.lo), y = pixel_row(1, v.hi, v.lo);
    vec2 w = PERSPECTIVE ? pixel_row(2, v.hi, v.lo) : vec2(1.0, 0.0);
    return vec2(add(x, scale(w, -anchor.x)).x, add(y, scale(w, -anchor.y)).x) / w.x;
}

bool triangle_of(uint i, out Triangle t) {
    for (int k = 0; k < 3; k++) t.corners[k] = elements[3 * i + k];
    t.a = vertex_of(t.corners[0]);
    t.b = vertex_of(t.corners[1]);
    t.c = vertex_of(t.corners[2]);
    t.anchor = floor(clamp(screen_of(t.a.hi, t.a.lo), vec2(0.0), frame.viewport));
    t.screen[0] = from_anchor(t.a, t.anchor);
    t.screen[1] = from_anchor(t.b, t.anchor);
    t.screen[2] = from_anchor(t.c, t.anchor);
    return min(min(t.a.radius, t.b.radius), t.c.radius) >= 0.0 && max(max(t.a.distance, t.b.distance), t.c.distance) >= view.near;
}

// First and last pixel of the bounding box: the whole viewport if a part is in front of the near plane.
ivec4 box_of(Triangle t) {
    vec2 low = vec2(0.0), high = frame.viewport - 1.0;
    if (min(min(t.a.distance, t.b.distance), t.c.distance) >= view.near) {
        vec2 a = t.screen[0], b = t.screen[1], c = t.screen[2];
        // Bounded on both sides: integers far outside the picture would be undefined.
        low = clamp(t.anchor + floor(min(min(a, b), c)), low, frame.viewport);
        high = clamp(t.anchor + floor(max(max(a, b), c)), vec2(-1.0), high);
    }
    return ivec4(low, high);
}

// Signed edge function of the ray through a point `point` px from the anchor. Both triangles of an edge get the same value with opposite
// signs.
float edge_function(uint i, Vertex a, vec2 on_screen_a, uint j, Vertex b, vec2 on_screen_b, vec2 point) {
    bool swapped = i > j;
    Vertex p = b, q = a;
    vec2 e = point - on_screen_b;
    if (!swapped) {
        p = a;
        q = b;
        e = point - on_screen_a;
    }
    precise vec3 edge = (q.hi - p.hi) + (q.lo - p.lo);
    // The plane of edge and eye contains p, so only the ray's offset from p counts.
    precise vec3 from = PERSPECTIVE ? p.hi + p.lo : view.forward_hi.xyz;
    precise vec3 plane = from.yzx * edge.zxy - from.zxy * edge.yzx;
    precise vec3 offset = view.ray_hi[0].xyz * e.x + view.ray_hi[1].xyz * e.y;
    precise float side = plane.x * offset.x + plane.y * offset.y + plane.z * offset.z;
    return swapped ? -side : side;
}

// Barycentric weights, in world space, at a pixel's centre; false if it is outside the triangle.
bool weights_at(Triangle t, ivec2 pixel, out vec3 weights, out float distance) {
    vec2 point = vec2(pixel) - t.anchor + 0.5;
    weights.x = edge_function(t.corners[1], t.b, t.screen[1], t.corners[2], t.c, t.screen[2], point);
    weights.y = edge_function(t.corners[2], t.c, t.screen[2], t.corners[0], t.a, t.screen[0], point);
    weights.z = edge_function(t.corners[0], t.a, t.screen[0], t.corners[1], t.b, t.screen[1], point);
    distance = 0.0;
    float sum = weights.x + weights.y + weights.z;
    if (!(all(greaterThanEqual(weights, vec3(0.0))) || all(lessThanEqual(weights, vec3(0.0)))) || sum == 0.0) return false;
    weights /= sum;
    distance = dot(weights, vec3(t.a.distance, t.b.distance, t.c.distance));
    return distance >= view.near && !is_beyond_far(distance);
}

Sample sample_at(Triangle t, ivec2 pixel, vec3 weights, float distance) {
    vec3 plane = cross(t.b.hi - t.a.hi, t.c.hi - t.a.hi);
    vec3 direction = weights.x * t.a.direction + weights.y * t.b.direction + weights.z * t.c.direction;
    // Its front is the side of its normals; seen from behind, they are negated.
    bool is_front = dot(plane, t.a.direction + t.b.direction + t.c.direction) >= 0.0;
    if (facing_of(t.a.hi, is_front ? plane : -plane) > 0.0) direction = -direction;
    float radius = dot(weights, vec3(t.a.radius, t.b.radius, t.c.radius));
    vec2 point = vec2(pixel) + 0.5;
    Sample s = disc_sample(point, point, distance, distance, radius, direction, false);
    s.colour = weights.x * t.a.colour + weights.y * t.b.colour + weights.z * t.c.colour;
    s.coordinates = weights.x * t.a.coordinates + weights.y * t.b.coordinates + weights.z * t.c.coordinates;
    return s;
}
