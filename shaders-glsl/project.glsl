// Project: finds the nearest point of each pixel (marroquim2008 §3.1). A surfel is one point; segments (LINES) and TRIANGLES are several.
// RASTER_POINTS copies the points of the raster path to the buffer of nearest points. COUNT_ONLY counts the surfels that the raster path
// draws.
#version 450
#pragma variant LINES
#pragma variant TRIANGLES
#pragma variant RASTER_POINTS
#pragma variant COUNT_ONLY
#extension GL_GOOGLE_include_directive : require
#ifdef COMPUTE
#ifndef COUNT_ONLY
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif
#ifdef RASTER_POINTS
#extension GL_EXT_samplerless_texture_functions : require
#endif

#if !defined(LINES) && !defined(TRIANGLES) && !defined(RASTER_POINTS) && !defined(COUNT_ONLY)
#define VISIBLE_ACCESS readonly
#define PER_CLUSTER
#include "lib/visible_clusters.glsl"
#endif
#ifdef RASTER_POINTS
#include "lib/frame.glsl"
#else
#include "lib/instance.glsl"
#endif
#ifndef COUNT_ONLY
#define NEAREST_ACCESS
#include "lib/nearest_points.glsl"
#endif
#if defined(LINES) || defined(TRIANGLES)
#include "lib/sums.glsl"
#include "lib/pyramid.glsl"
#include "lib/camera_rays.glsl"
#endif

#ifdef RASTER_POINTS
#include "lib/pixel_group.glsl"
#else
layout(local_size_x = 64) in;
#endif

#if !defined(COUNT_ONLY) && !defined(RASTER_POINTS)
// Projects a point of element i of the chunk to a pixel, clamped to the viewport: the buffer is written without a check of bounds.
void project(uint i, ivec2 at, float distance) {
    uvec2 size = uvec2(frame.viewport), inside = min(uvec2(at), size - 1);
    uint pixel = inside.y * size.x + inside.x;
    atomicMin(nearest_points[pixel], nearest_point(first_id() + i, world_distance(distance)));
}
#endif

#if defined(LINES)

#include "lib/primitives.glsl"
#include "lib/line.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    Segment segment;
    if (i >= chunk.count || !segment_of(i, segment)) return;
    for (int k = 0; k < segment.strands; k++) {
        Strand strand;
        if (!strand_of(segment, k, strand)) continue;
        ivec2 columns = columns_of(strand);
        for (int column = columns.x; column <= columns.y; column++) {
            StrandPoint point;
            if (strand_point(segment, strand, column, point)) project(i, point.pixel, point.nearest);
        }
    }
}

#elif defined(TRIANGLES)

#include "lib/primitives.glsl"
#include "lib/triangle.glsl"

// Triangles of more pixels than an invocation should visit are listed, and rasterized by a second dispatch with a workgroup per triangle.
layout(constant_id = 30) const bool LARGE_TRIANGLES = false;
const uint MOST_PIXELS = 64; // largest box of a triangle that is not listed, pixels
layout(set = 0, binding = 16, std430) buffer LargeTriangles { uint large_triangles[]; }; // list lengths (LIST_HEADER), then lists of element indices

void project_box(uint i, Triangle triangle, ivec4 box, uint first, uint step) {
    uint width = uint(box.z - box.x + 1), area = width * uint(box.w - box.y + 1);
    for (uint k = first; k < area; k += step) {
        ivec2 at = box.xy + ivec2(k % width, k / width);
        vec3 weights;
        float distance;
        if (weights_at(triangle, at, weights, distance)) project(i, at, distance);
    }
}

void main() {
    uint instance = instance_index();
    Triangle triangle;
    if (LARGE_TRIANGLES) {
        for (uint k = gl_WorkGroupID.x; k < large_triangles[instance]; k += gl_NumWorkGroups.x) {
            uint i = large_triangles[list_start() + k];
            triangle_of(i, triangle);
            project_box(i, triangle, box_of(triangle), gl_LocalInvocationIndex, gl_WorkGroupSize.x);
        }
        return;
    }
    uint i = gl_GlobalInvocationID.x;
    if (i >= chunk.count || !triangle_of(i, triangle)) return;
    ivec4 box = box_of(triangle);
    if (any(greaterThan(box.xy, box.zw))) return;
    ivec2 size = box.zw - box.xy + 1;
    if (uint(size.x) * uint(size.y) > MOST_PIXELS) large_triangles[list_start() + atomicAdd(large_triangles[instance], 1)] = i;
    else project_box(i, triangle, box, 0, 1);
}

#elif defined(RASTER_POINTS)

#include "lib/raster_points.glsl"

void main() {
    ivec2 pixel = invocation_pixel(), size = picture_size();
    if (any(greaterThanEqual(pixel, size))) return;
    uint id;
    float distance;
    bool found = raster_point(pixel, id, distance);
    nearest_points[pixel.y * size.x + pixel.x] = found ? nearest_point(id, distance) : NO_POINT;
}

#else

#include "lib/surfel_normal.glsl"
#include "lib/point.glsl"

void main() {
#ifdef PER_CLUSTER
    uint i = entry_of_invocation();
#else
    uint i = gl_GlobalInvocationID.x;
#endif
    if (i >= chunk.count) return;
    Point point;
    uint reason = point_of(i, point);
    count(reason);
#ifndef COUNT_ONLY
    if (reason == DRAWN) project(i, point.pixel, point.distance);
#endif
}

#endif
#endif
