// Fetch: writes the samples of level 0 from the nearest point of each pixel, which is of a surfel, a segment (LINES) or a triangle
// (TRIANGLES). With RASTER_POINTS the points of surfels come from the raster path.
#version 450
#pragma variant LINES
#pragma variant TRIANGLES
#pragma variant RASTER_POINTS
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE

#ifdef RASTER_POINTS
#extension GL_EXT_samplerless_texture_functions : require
#else
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#endif

#include "lib/instance.glsl"
#include "lib/sums.glsl"
#include "lib/pixel_group.glsl"
#include "lib/pyramid.glsl"
#include "lib/camera_rays.glsl"
#ifdef RASTER_POINTS
#include "lib/raster_points.glsl"
#else
#define NEAREST_ACCESS readonly
#include "lib/nearest_points.glsl"
#endif
#include "lib/occupied_tiles.glsl"

PYRAMID_TO_WRITE(2, to)

#if defined(LINES)

#include "lib/primitives.glsl"
#include "lib/line.glsl"

// Largest relative difference of a distance from that of project: drivers may round the same arithmetic otherwise in another pipeline.
const float ROUNDING = 1e-6;

// The sample of a segment's only strand, or of the first with this point. Repeats the arithmetic of project.
Sample sample_of(uint i, ivec2 pixel, uint nearest) {
    Segment segment;
    segment_of(i, segment);
    for (int k = 0; k < segment.strands; k++) {
        Strand strand;
        StrandPoint point;
        if (!strand_of(segment, k, strand) || !strand_point(segment, strand, pixel[strand.steep], point)) continue;
        ivec2 columns = columns_of(strand);
        bool in_range = pixel[strand.steep] >= columns.x && pixel[strand.steep] <= columns.y;
        float distance = uintBitsToFloat(nearest);
        bool is_same = in_range && point.pixel == pixel && abs(world_distance(point.nearest) - distance) <= ROUNDING * distance;
        point.pixel = pixel;
        if (segment.strands == 1 || is_same) return sample_at(segment, strand, point);
    }
    return NO_SAMPLE;
}

#elif defined(TRIANGLES)

#include "lib/primitives.glsl"
#include "lib/triangle.glsl"

Sample sample_of(uint i, ivec2 pixel, uint nearest) {
    Triangle triangle;
    triangle_of(i, triangle);
    vec3 weights;
    float distance;
    weights_at(triangle, pixel, weights, distance);
    return sample_at(triangle, pixel, weights, INSTANCED ? distance : uintBitsToFloat(nearest));
}

#else

#include "lib/surfel_attributes.glsl"
#include "lib/point.glsl"

// Least radius of a point's disc, px: smaller ones would not cover their own pixel's centre.
const float LEAST_RADIUS = 1.0;

Sample sample_of(uint i, ivec2 pixel, uint nearest) {
    Point point;
    point_of(i, point);
    float radius = radius_of(i);
    // A circle of the ellipse's area.
    if (ELLIPSES && !is_billboard(i)) radius *= sqrt(ellipse_of(i).w);
    float least = PAPER ? 0.0 : LEAST_RADIUS / focal_scale() * (PERSPECTIVE ? from_eye(point.distance) : 1.0);
    vec3 normal = normal_of(i);
    Sample s = NO_SAMPLE;
    s.subpixel = radius < least;
    s.back = CULL_AUTO && point.facing > 0.0 && !is_two_sided(i);
    radius = max(radius, least);
    s.near = s.depth = point.distance;
    s.far = point.distance + (PAPER ? 1.0 : 2.0) * radius;
    s.radius = focal_scale() * radius / (PERSPECTIVE ? from_eye(point.distance) : 1.0);
    s.displacement = PAPER ? vec2(0.0) : point.offset;
    // Seen from behind, a disc has the opposite normal.
    s.normal = point.facing > 0.0 ? -normal : normal;
    s.colour = colour_of(i);
    if (TEXTURE) s.coordinates = coordinates_of(i);
    return s;
}

#endif

// Transforms a sample from scene space to world space.
Sample to_world_sample(Sample s) {
    if (!INSTANCED || s.near == 0.0) return s;
    s.near = world_distance(s.near);
    s.far *= view.scale;
    s.depth *= view.scale;
    s.normal = to_world(s.normal);
    return s;
}

// Reads the id and the bits of the distance of the nearest point of a pixel; false if the pixel has none.
bool nearest_at(uint index, ivec2 pixel, out uint id, out uint nearest) {
#ifdef RASTER_POINTS
    float distance;
    bool found = raster_point(pixel, id, distance);
    nearest = floatBitsToUint(distance);
    return found;
#else
    uint64_t point = nearest_points[index];
    id = uint(point & 0xffffffffu);
    nearest = uint(point >> 32);
    return point != NO_POINT;
#endif
}

void main() {
    ivec2 pixel = LISTED_PIXEL(occupied, 0);
    if (!is_within(picture_size(), pixel)) return;
    uint index = uint(pixel.y * picture_size().x + pixel.x);
    uint id, nearest;
    if (nearest_at(index, pixel, id, nearest) && id - first_id() < chunk.count) {
        Sample s = to_world_sample(sample_of(id - first_id(), pixel, nearest));
        s.id = id;
        store_to(pixel, s);
    }
}

#endif
