// Vertices of ribbons, tubes and triangles.

#include "lib/double_float.glsl"
#include "lib/pixel_row.glsl"
#include "lib/colour_streams.glsl"

layout(constant_id = 29) const uint VERTEX_COLOURS = 0; // colour format: see lib/colour_streams.glsl

layout(set = 0, binding = 12, std430) readonly buffer Vertices { float vertices[]; };            // position, direction, radius
layout(set = 0, binding = 13, std430) readonly buffer LineDirections { float line_directions[]; };                // directions of the lines
layout(set = 0, binding = 14, std430) readonly buffer VertexColours { uint vertex_colours[]; };
layout(set = 0, binding = 15, std430) readonly buffer Elements { uint elements[]; };             // vertices of lines, or of triangles

struct Vertex {
    vec3 hi, lo;      // position relative to the eye, as the sum of both
    vec3 direction;   // unit: normal, or tangent of a tube
    float radius;     // below 0 if invalid
    float distance;
    vec3 colour;      // linear
    vec2 coordinates; // in the texture
};

float distance_of(vec3 hi, vec3 lo) {
    return counted_distance(dot_double(hi, lo, view.forward_hi.xyz, view.forward_lo.xyz)).x;
}

DEFINE_COLOURS(vertex_colour, VERTEX_COLOURS, vertex_colours, 0, colour_words(VERTEX_COLOURS))
DEFINE_COORDINATES(vertex_coordinates, vertex_colours)

Vertex vertex_of(uint i) {
    uint k = 7 * i;
    Vertex v;
    vec2 x = two_sum(vertices[k], -view.eye_hi.x);
    vec2 y = two_sum(vertices[k + 1], -view.eye_hi.y);
    vec2 z = two_sum(vertices[k + 2], -view.eye_hi.z);
    v.hi = vec3(x.x, y.x, z.x);
    v.lo = vec3(x.y, y.y, z.y) - view.eye_lo.xyz;
    v.direction = vec3(vertices[k + 3], vertices[k + 4], vertices[k + 5]);
    v.radius = vertices[k + 6];
    v.distance = distance_of(v.hi, v.lo);
    v.colour = SUM_COLOURS ? vertex_colour(i) : vec3(0.0);
    v.coordinates = vec2(0.0);
    if (TEXTURE) v.coordinates = vertex_coordinates(i);
    return v;
}

// Position on the screen, px.
vec2 screen_of(vec3 hi, vec3 lo) {
    vec2 x = pixel_row(0, hi, lo), y = pixel_row(1, hi, lo);
    return vec2(x.x, y.x) / (PERSPECTIVE ? pixel_row(2, hi, lo).x : 1.0);
}

bool is_beyond_far(float distance) {
    return key_at_distance(distance) < frame.key_far;
}

// Below 0 if a plane with this normal, at a position relative to the eye, faces it.
float facing_of(vec3 position, vec3 normal) {
    return dot(PERSPECTIVE ? position : view.forward_hi.xyz, normal);
}

// Sample of the pixel with this `centre` from a disc around `screen` whose nearest point is at distance `nearest`; without colour and
// coordinates.
Sample disc_sample(vec2 centre, vec2 screen, float nearest, float distance, float radius, vec3 direction, bool tube) {
    Sample s = NO_SAMPLE;
    s.near = nearest;
    s.far = distance + (PAPER || tube ? 1.0 : 2.0) * radius;
    s.depth = distance;
    s.radius = focal_scale() * radius / (PERSPECTIVE ? from_eye(distance) : 1.0);
    s.displacement = PAPER ? vec2(0.0) : screen - centre;
    s.normal = dot(direction, direction) > 0.0 ? normalize(direction) : vec3(0.0);
    s.tube = tube;
    return s;
}
