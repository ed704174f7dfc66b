// Points: surfels drawn as points of one pixel, of which the depth test leaves the nearest, and of two as near the first (marroquim2008 §3.1).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef VERTEX

#define VERTICES 1
#include "lib/instance.glsl"
#include "lib/surfels.glsl"
#include "lib/point.glsl"
#include "lib/drawn_points.glsl"

layout(location = 0) flat out uint number;

void main() {
    Point point;
    bool drawn = point_of(surfel_number(), point) == DRAWN;
    // At the middle of its pixel, so that no rasterizer takes another; what is culled lies off the picture.
    vec2 middle = 2.0 * (vec2(point.at) + 0.5) / frame.viewport - 1.0;
    gl_Position = drawn ? vec4(middle, depth_of(world_distance(point.distance)), 1.0) : vec4(-3.0, -3.0, 0.0, 1.0);
    gl_PointSize = 1.0;
    number = first_number() + surfel_number();
}

#endif
#ifdef FRAGMENT

layout(location = 0) flat in uint number;

layout(location = 0) out uint nearest_number;

void main() {
    nearest_number = number + 1;
}

#endif
