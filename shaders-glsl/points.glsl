// Points: rasterizes surfels as points of one pixel. The depth test keeps the nearest; of two at equal depth, the first (marroquim2008
// §3.1).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef VERTEX

#define VERTICES 1
#include "lib/instance.glsl"
#include "lib/surfel_normal.glsl"
#include "lib/point.glsl"
#include "lib/raster_points.glsl"

layout(location = 0) flat out uint id;

void main() {
    Point point;
    bool visible = point_of(surfel_index(), point) == DRAWN;
    // At the pixel centre, so that all rasterizers choose the same pixel. Culled points lie outside the viewport.
    vec2 position = 2.0 * (vec2(point.pixel) + 0.5) / frame.viewport - 1.0;
    gl_Position = visible ? vec4(position, depth_of(world_distance(point.distance)), 1.0) : vec4(-3.0, -3.0, 0.0, 1.0);
    gl_PointSize = 1.0;
    id = first_id() + surfel_index();
}

#endif
#ifdef FRAGMENT

layout(location = 0) flat in uint id;

layout(location = 0) out uint nearest_id;

void main() {
    nearest_id = id + 1;
}

#endif
