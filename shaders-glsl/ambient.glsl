// Ambient: darkens the picture by its ambient occlusion, the mean of the blocks around each pixel that show its surface (petschnigg2004's joint
// bilateral filter).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/background.glsl"
#include "lib/pixel_group.glsl"
#include "lib/occlusion.glsl"

layout(constant_id = 77) const bool EDL = false; // pass `edl` is next

layout(set = 1, binding = 3, rgba32f) uniform image2D image_output;
layout(set = 1, binding = 20, r32f) readonly uniform image2D depth_output;
layout(set = 1, binding = 27, rgba32f) readonly uniform image2D occlusion;

// Distance from a pixel's surface at which a block counts half, as a part of the radius.
const float APART = 0.125;
// Least part of the light that is left.
const float DARKEST = 1.0 / 1024.0;

const ivec2 CORNERS[4] = ivec2[](ivec2(-1, -1), ivec2(0, -1), ivec2(-1, 0), ivec2(0, 0));

// The image of tiles without splats may be undefined, as in pass edl.
//
// Four pixels around a corner of blocks have the same 4 × 4 blocks around them, in which each direction and distance of samples is once.
void main() {
    ivec2 corner = invocation_pixel(), size = picture_size();
    if (any(greaterThan(2 * corner - 1, size - 1))) return;
    vec4 depths = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 pixel = 2 * corner + CORNERS[i], inside = clamp(pixel, ivec2(0), size - 1);
        depths[i] = inside == pixel ? imageLoad(depth_output, pixel).r : 0.0;
    }
    float apart = max(1.0, APART * occlusion_radius());
    vec4 per_width = 1.0 / (apart * frame.pixel_width * (PERSPECTIVE ? max(depths, vec4(1e-30)) : vec4(1.0)));
    vec4 sums = vec4(0.0), weights = vec4(0.0);
    ivec2 last = (size + 1) / 2 - 1;
    for (int j = -2; j < 2; j++) {
        for (int i = -2; i < 2; i++) {
            ivec2 block = corner + ivec2(i, j), inside = clamp(block, ivec2(0), last);
            vec4 values = imageLoad(occlusion, inside);
            vec2 from = vec2(2 * corner - sampled_pixel(inside));
            // How far the pixels' surfaces are from the block's plane.
            float climb = dot(values.zw, from - 1.0);
            vec4 plane = climb + vec4(0.0, values.z, values.w, values.z + values.w);
            vec4 distance = (values.y - depths) * per_width - plane / apart;
            distance *= distance;
            vec4 weight = inside == block && values.y > 0.0 ? 1.0 / (1.0 + distance * distance) : vec4(0.0);
            sums += weight * values.x;
            weights += weight;
        }
    }
    for (int i = 0; i < 4; i++) {
        ivec2 pixel = 2 * corner + CORNERS[i];
        if (clamp(pixel, ivec2(0), size - 1) != pixel) continue;
        vec4 image = imageLoad(image_output, pixel);
        if (depths[i] > 0.0 && weights[i] > 0.0) image.rgb *= pow(max(1.0 - sums[i] / weights[i], DARKEST), frame.ao);
        if (FILTER_RADIUS == 0 && !EDL) image = depths[i] > 0.0 ? over_background(image.rgb, image.a) : frame.background;
        imageStore(image_output, pixel, image);
    }
}

#endif
