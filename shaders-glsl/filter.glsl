// Filter: convolves the lit picture with a Gaussian, and blends it with the background. It does after light what the low-pass filter of
// splats does before it (zwicker2004 equation 3), so that edges of surfaces are filtered, too.
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/background.glsl"

// An invocation filters STRIP pixels of a column, from the sums of the last rows; as many as in src/frame/recording.rs.
layout(local_size_x = 64) in;
const int STRIP = 16;

layout(constant_id = 31) const bool COVERAGE = false; // α is filtered; otherwise it stays, and only pixels with a surface have a colour

layout(set = 1, binding = 3, rgba32f) readonly uniform image2D image_output;
layout(set = 1, binding = 23, rgba32f) writeonly uniform image2D filtered;

const int RADIUS = int(FILTER_RADIUS), TAPS = 2 * RADIUS + 1;

float weights[RADIUS + 1];

// Weight of a pixel at distance `offset`; 0 outside the picture.
float weight(int offset, int at, int size) {
    return at >= 0 && at < size ? weights[abs(offset)] : 0.0;
}

// Sum of the weights around a pixel along a side of the picture.
float total(int centre, int size) {
    float sum = 0.0;
    for (int k = -RADIUS; k <= RADIUS; k++) sum += weight(k, centre + k, size);
    return sum;
}

// Weighted sum along a row; rgb are premultiplied by α.
vec4 row_sum(ivec2 pixel, ivec2 size) {
    vec4 sum = vec4(0.0);
    if (pixel.y < 0 || pixel.y >= size.y) return sum;
    for (int k = -RADIUS; k <= RADIUS; k++) {
        int x = pixel.x + k;
        vec4 value = imageLoad(image_output, ivec2(clamp(x, 0, size.x - 1), pixel.y));
        sum += weight(k, x, size.x) * vec4(value.a * value.rgb, value.a);
    }
    return sum;
}

vec4 filtered_pixel(ivec2 pixel, vec4 mean) {
    float alpha = COVERAGE ? mean.a : imageLoad(image_output, pixel).a;
    return alpha > 0.0 ? over_background(mean.rgb / mean.a, alpha) : frame.background;
}

void main() {
    ivec2 size = ivec2(frame.viewport);
    int x = int(gl_GlobalInvocationID.x), first = STRIP * int(gl_GlobalInvocationID.y);
    if (x >= size.x) return;
    for (int k = 0; k <= RADIUS; k++) weights[k] = exp(-0.5 / frame.pixel_filter * float(k * k));
    float across = total(x, size.x);
    vec4 rows[TAPS];
    for (int k = 0; k < TAPS; k++) rows[k] = vec4(0.0);
    int last = min(first + STRIP, size.y) + RADIUS;
    for (int row = first - RADIUS; row < last; row++) {
        for (int k = 1; k < TAPS; k++) rows[k - 1] = rows[k];
        rows[TAPS - 1] = row_sum(ivec2(x, row), size);
        int y = row - RADIUS;
        if (y < first) continue;
        vec4 sum = vec4(0.0);
        for (int k = 0; k < TAPS; k++) sum += weights[abs(k - RADIUS)] * rows[k];
        imageStore(filtered, ivec2(x, y), filtered_pixel(ivec2(x, y), sum / (across * total(y, size.y))));
    }
}

#endif
