// Fetch: each pixel of level 0 takes what its nearest point is: of a surfel, a segment (LINES) or a triangle (TRIANGLES). Surfels alone may
// have been drawn (DRAWN_POINTS).
#version 450
#pragma variant LINES
#pragma variant TRIANGLES
#pragma variant DRAWN_POINTS
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#ifdef DRAWN_POINTS
#extension GL_EXT_samplerless_texture_functions : require
#else
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif

#include "lib/instance.glsl"
#include "lib/sums.glsl"
#define SAMPLES_ONLY
#include "lib/pyramid.glsl"
#include "lib/lens.glsl"
#ifdef DRAWN_POINTS
#include "lib/drawn_points.glsl"
#else
#define NEAREST_ACCESS readonly
#include "lib/nearest_points.glsl"
#endif

PYRAMID(2, to, writeonly)
STORED(to)

layout(local_size_x = 64) in;

#if defined(LINES)

#include "lib/primitives.glsl"
#include "lib/line.glsl"

// The first strand with this point: the same arithmetic that found it finds it again.
Sample sample_of(uint i, ivec2 at, uint nearest) {
    Segment segment;
    segment_of(i, segment);
    for (int k = 0; k < segment.strands; k++) {
        Strand strand;
        Place place;
        if (!strand_of(segment, k, strand) || !place_of(segment, strand, at[strand.steep], place)) continue;
        ivec2 columns = columns_of(strand);
        bool reached = at[strand.steep] >= columns.x && at[strand.steep] <= columns.y;
        if (reached && place.at == at && floatBitsToUint(world_distance(place.nearest)) == nearest) return sample_at(segment, strand, place);
    }
    return NOTHING;
}

#elif defined(TRIANGLES)

#include "lib/primitives.glsl"
#include "lib/triangle.glsl"

Sample sample_of(uint i, ivec2 at, uint nearest) {
    Triangle triangle;
    triangle_of(i, triangle);
    vec3 weights;
    float distance;
    weights_at(triangle, at, weights, distance);
    return sample_at(triangle, at, weights, INSTANCED ? distance : uintBitsToFloat(nearest));
}

#else

#include "lib/surface.glsl"
#include "lib/point.glsl"

Sample sample_of(uint i, ivec2 at, uint nearest) {
    Point point;
    point_of(i, point);
    float radius = radius_of(i);
    // A disc of the ellipse's area.
    if (ELLIPSES) radius *= sqrt(ellipse_of(i).w);
    vec3 normal = normal_of(i);
    Sample s = NOTHING;
    s.near = s.depth = point.distance;
    s.far = point.distance + (PAPER ? 1.0 : 2.0) * radius;
    s.radius = focal_scale() * radius / (PERSPECTIVE ? point.distance : 1.0);
    s.displacement = PAPER ? vec2(0.0) : point.offset;
    // Seen from behind, a disc is that of the opposite normal.
    s.normal = point.facing > 0.0 ? -normal : normal;
    s.colour = colour_of(i);
    if (TEXTURE) s.coordinates = coordinates_of(i);
    return s;
}

#endif

// A sample of the scene's as the scenes share it.
Sample shared_sample(Sample s) {
    if (!INSTANCED || s.near == 0.0) return s;
    s.near = world_distance(s.near);
    s.far *= view.scale;
    s.depth *= view.scale;
    s.normal = in_world(s.normal);
    return s;
}

// What is nearest at a pixel, and the bits of its distance; false where nothing is.
bool nearest_at(uint pixel, ivec2 at, out uint number, out uint nearest) {
#ifdef DRAWN_POINTS
    float distance;
    bool there = drawn_point(at, number, distance);
    nearest = floatBitsToUint(distance);
    return there;
#else
    uint64_t point = nearest_points[pixel];
    number = uint(point & 0xffffffffu);
    nearest = uint(point >> 32);
    return point != NO_POINT;
#endif
}

void main() {
    uvec2 size = uvec2(frame.viewport);
    uint pixel = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (pixel >= size.x * size.y) return;
    ivec2 at = ivec2(pixel % size.x, pixel / size.x);
    uint number, nearest;
    if (!nearest_at(pixel, at, number, nearest)) {
        if (first_number() == 0) store_to(pixel, NOTHING);
    } else if (number - first_number() < window.count) {
        Sample s = shared_sample(sample_of(number - first_number(), at, nearest));
        s.id = number;
        store_to(pixel, s);
    }
}

#endif
