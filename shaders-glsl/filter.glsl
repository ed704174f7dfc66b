// Filter: convolves the lit picture with a Gaussian, rows first, then columns, and blends it with the background. It does after light what
// the low-pass filter of splats does before it (zwicker2004 equation 3), so that edges of surfaces are filtered, too.
#version 450
#pragma variant COLUMNS COMPUTE
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/background.glsl"
#include "lib/pixel_group.glsl"

layout(constant_id = 31) const bool COVERAGE = false; // α is filtered; otherwise it stays, and only pixels with a surface have a colour

#ifdef COLUMNS
layout(set = 1, binding = 3, rgba32f) uniform image2D image_output;
layout(set = 1, binding = 23, rgba32f) readonly uniform image2D filtered_rows; // premultiplied by α
const ivec2 STEP = ivec2(0, 1);
#else
layout(set = 1, binding = 3, rgba32f) readonly uniform image2D image_output;
layout(set = 1, binding = 23, rgba32f) writeonly uniform image2D filtered_rows;
const ivec2 STEP = ivec2(1, 0);
#endif

// Premultiplied colour and α.
vec4 load(ivec2 pixel) {
#ifdef COLUMNS
    return imageLoad(filtered_rows, pixel);
#else
    vec4 pixel_value = imageLoad(image_output, pixel);
    return vec4(pixel_value.a * pixel_value.rgb, pixel_value.a);
#endif
}

// Weighted mean along STEP over the pixels of the picture.
vec4 convolve(ivec2 pixel, ivec2 size) {
    const int radius = int(FILTER_RADIUS);
    float exponent = -0.5 / frame.pixel_filter;
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int k = -radius; k <= radius; k++) {
        ivec2 at = pixel + k * STEP, within = clamp(at, ivec2(0), size - 1);
        float weight = at == within ? exp(exponent * float(k * k)) : 0.0;
        sum += weight * load(within);
        weights += weight;
    }
    return sum / weights;
}

void main() {
    ivec2 pixel = invocation_pixel(), size = picture_size();
    if (any(greaterThanEqual(pixel, size))) return;
    vec4 mean = convolve(pixel, size);
#ifdef COLUMNS
    float alpha = COVERAGE ? mean.a : imageLoad(image_output, pixel).a;
    // Pixels without a surface are 0 already, and stores are most of the cost.
    if (alpha > 0.0) {
        imageStore(image_output, pixel, over_background(mean.rgb / mean.a, alpha));
    } else if (frame.background != vec4(0.0)) {
        imageStore(image_output, pixel, frame.background);
    }
#else
    imageStore(filtered_rows, pixel, mean);
#endif
}

#endif
