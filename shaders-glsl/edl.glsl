// Eye-dome lighting: darkens pixels behind their neighbours, so that shape shows where normals are unknown (boucheny2009).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/background.glsl"
#include "lib/pixel_group.glsl"

layout(set = 1, binding = 3, rgba32f) uniform image2D image_output;
layout(set = 1, binding = 20, r32f) readonly uniform image2D depth_output;

// How far in front of a pixel at distance `depth` its neighbour `step` px away is, in widths of a pixel between both, per px; 0 if it is
// behind or has no surface.
float rise_to(ivec2 pixel, ivec2 step, ivec2 size, float depth) {
    ivec2 neighbour = pixel + step;
    if (any(lessThan(neighbour, ivec2(0))) || any(greaterThanEqual(neighbour, size))) return 0.0;
    float near = imageLoad(depth_output, neighbour).r;
    if (!(near > 0.0 && near < depth)) return 0.0;
    float width = frame.pixel_width * (PERSPECTIVE ? 0.5 * (depth + near) : 1.0);
    return (depth - near) / (width * length(vec2(step)));
}

// The image of tiles without splats may be undefined, before and after: it has no depths there, and pass filter does not read it.
void main() {
    ivec2 pixel = invocation_pixel(), size = picture_size();
    if (any(greaterThanEqual(pixel, size))) return;
    float depth = imageLoad(depth_output, pixel).r;
    vec4 image = imageLoad(image_output, pixel);
    if (depth > 0.0) {
        float rise = 0.0;
        for (int y = -1; y <= 1; y++) {
            for (int x = -1; x <= 1; x++) rise += x == 0 && y == 0 ? 0.0 : rise_to(pixel, ivec2(x, y), size, depth);
        }
        image.rgb *= exp(-frame.edl * rise / 8.0);
    }
    if (FILTER_RADIUS == 0) image = depth > 0.0 ? over_background(image.rgb, image.a) : frame.background;
    imageStore(image_output, pixel, image);
}

#endif
