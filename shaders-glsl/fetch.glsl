// Fetch: each pixel of level 0 takes what its nearest point is: of a surfel, a segment (LINES) or a triangle (TRIANGLES).
#version 450
#pragma variant LINES
#pragma variant TRIANGLES
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require

#include "lib/frame.glsl"
#include "lib/window.glsl"
#include "lib/sums.glsl"
#define SAMPLES_ONLY
#include "lib/pyramid.glsl"
#include "lib/lens.glsl"
#include "lib/nearest_points.glsl"

DEFINE_PYRAMID(2, to)

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
        if (reached && place.at == at && floatBitsToUint(place.nearest) == nearest) return sample_at(segment, strand, place);
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
    return sample_at(triangle, at, weights, uintBitsToFloat(nearest));
}

#else

#include "lib/surface.glsl"
#include "lib/point.glsl"

Sample sample_of(uint i, ivec2 at, uint nearest) {
    Sample s;
    point_of(i, at, s);
    s.colour = colour_of(i);
    if (TEXTURE) s.coordinates = coordinates_of(i);
    return s;
}

#endif

void main() {
    ivec2 size = ivec2(frame.viewport);
    uint pixel = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (pixel >= uint(size.x) * uint(size.y)) return;
    uint64_t point = nearest_points[pixel];
    uint i = uint(point & 0xffffffffu) - window.first;
    if (point == NO_POINT) {
        if (window.first == 0) store_to(pixel, NOTHING);
    } else if (i < window.count) {
        Sample s = sample_of(i, ivec2(pixel % uint(size.x), pixel / uint(size.x)), uint(point >> 32));
        s.id = window.first + i;
        store_to(pixel, s);
    }
}

#endif
