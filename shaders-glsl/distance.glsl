// Distance: a host's depth → eye-space distances, and a white picture that `ambient` and `edl` darken (src/embed/depth_shading).
#version 450
#pragma variant MULTISAMPLED COMPUTE
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pixel_group.glsl"

layout(constant_id = 43) const uint HOST_SAMPLES = 1;

// A surface at distance z has the depth first.x + first.y + by_distance / z in perspective, first.x + first.y + by_distance z otherwise.
layout(push_constant) uniform Distance {
    vec2 first;        // the sum of two floats
    float by_distance;
    float farthest;    // depth at and beyond which there is no surface
    ivec2 origin;      // of the viewport in the host's depth, px
    float nearer;      // 1 if greater depth is nearer, else −1
} conversion;

layout(set = 1, binding = 3, rgba32f) writeonly uniform image2D image_output;
layout(set = 1, binding = 20, r32f) writeonly uniform image2D depth_output;
#ifdef MULTISAMPLED
layout(set = 2, binding = 0) uniform texture2DMS host_depth_samples;
#else
layout(set = 2, binding = 0) uniform texture2D host_depth_image;
#endif

// Depth of the nearest sample of a pixel.
float depth_at(ivec2 pixel) {
#ifdef MULTISAMPLED
    float depth = texelFetch(host_depth_samples, pixel, 0).r;
    for (int k = 1; k < int(HOST_SAMPLES); k++) {
        float other = texelFetch(host_depth_samples, pixel, k).r;
        if (conversion.nearer * (other - depth) > 0.0) depth = other;
    }
    return depth;
#else
    return texelFetch(host_depth_image, pixel, 0).r;
#endif
}

// Distance of the surface of this depth; 0 without one.
float distance_of(float depth) {
    if (!(conversion.nearer * (depth - conversion.farthest) > 0.0)) return 0.0;
    float above = (depth - conversion.first.x) - conversion.first.y;
    float z = PERSPECTIVE ? conversion.by_distance / above : above / conversion.by_distance;
    return z > 0.0 && !isinf(z) ? z : 0.0;
}

void main() {
    ivec2 pixel = invocation_pixel();
    if (any(greaterThanEqual(pixel, picture_size()))) return;
    imageStore(depth_output, pixel, vec4(distance_of(depth_at(conversion.origin + pixel))));
    imageStore(image_output, pixel, vec4(1.0));
}

#endif
