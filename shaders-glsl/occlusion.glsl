// Occlusion: the part of the light from the hemisphere over a surface that surfaces around it occlude, by their horizons on the screen
// (bavoil2008, with the cosine-weighted integral of jimenez2016).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pixel_group.glsl"
#include "lib/ray_step.glsl"
#include "lib/occlusion.glsl"

layout(set = 1, binding = 20, r32f) readonly uniform image2D depth_output;
layout(set = 1, binding = 27, rgba32f) writeonly uniform image2D occlusion;

// Slices of the hemisphere through the ray, and samples on either side of it in each.
const int SLICES = 2, STEPS = 8;
// Weight of a surface that faces the eye, beside 1 / (BEND² + bend²)² of each side.
const float FACING = 1.0 / 256.0;
// Differences of slopes up to which both sides of a pixel are of one surface.
const float BEND = 0.125;
// Outer part of the falloff in which a surface does not hide what is behind it.
const float OUTER = 0.125;

// Unit vectors over a quarter turn; the other slice is at right angles.
const vec2 DIRECTIONS[16] = vec2[](
    vec2(1.000000000, 0.000000000), vec2(0.995184720, 0.098017141), vec2(0.980785251, 0.195090324), vec2(0.956940353, 0.290284663),
    vec2(0.923879504, 0.382683426), vec2(0.881921291, 0.471396744), vec2(0.831469595, 0.555570245), vec2(0.773010433, 0.634393275),
    vec2(0.707106769, 0.707106769), vec2(0.634393275, 0.773010433), vec2(0.555570245, 0.831469595), vec2(0.471396744, 0.881921291),
    vec2(0.382683426, 0.923879504), vec2(0.290284663, 0.956940353), vec2(0.195090324, 0.980785251), vec2(0.098017141, 0.995184720));

// Distance of a pixel's surface; 0 without one, and outside of the picture.
float depth_at(ivec2 pixel) {
    ivec2 inside = clamp(pixel, ivec2(0), picture_size() - 1);
    return inside == pixel ? imageLoad(depth_output, pixel).r : 0.0;
}

// Slope along an axis, in widths of a pixel per px: of both sides, each weighted by how straight it is, and of a surface that faces the eye where
// neither is.
float slope(ivec2 pixel, ivec2 axis, float depth) {
    int base = int(max(1.0, floor(occlusion_radius() / 16.0)));
    float sum = 0.0, weights = FACING;
    for (int side = -base; side <= base; side += 2 * base) {
        float near = depth_at(pixel + side * axis), far = depth_at(pixel + 2 * side * axis);
        if (!(near > 0.0 && far > 0.0)) continue;
        float climb = rise(depth, near);
        float bend = (rise(depth, far) - 2.0 * climb) / float(base);
        float weight = 1.0 / (BEND * BEND + bend * bend);
        sum += weight * weight * climb / float(side);
        weights += weight * weight;
    }
    return sum / weights;
}

// (asin s − s √(1 − s²)) / 2 for s from 0 to 1, within 2e-8 but for rounding: asin of Abramowitz, Stegun, 4.4.46.
float segment(float s) {
    const float A[8] = float[](1.5707963050, -0.2145988016, 0.0889789874, -0.0501743046, 0.0308918810, -0.0170881256, 0.0066700901, -0.0012624911);
    float series = A[7];
    for (int k = 6; k >= 0; k--) series = series * s + A[k];
    float left = sqrt(1.0 - s);
    return 0.5 * (1.5707963268 - left * (series + s * sqrt(1.0 + s)));
}

// A slice of the hemisphere through the ray: unit vectors to the eye and across the ray, and the normal's part in each.
struct Slice {
    vec3 across;
    float facing, leaning, inverse;
};

// Adds a sample to the horizon of one side: .x is the occluded part so far, .y that below the horizon.
void add(inout vec2 horizon, vec3 offset, float side, Slice slice, vec3 normal, float radius) {
    // The sample moved into the slice, at its height over the tangent plane: rounding to a pixel moves it far on a surface seen edge-on.
    float squared = dot(offset, offset), high = dot(offset, normal), aside = side * dot(offset, slice.across);
    float lean = side * slice.leaning, lift = (high - lean * aside) / slice.facing;
    float height = clamp(high * slice.inverse * inversesqrt(aside * aside + lift * lift), 0.0, 1.0);
    // Beyond the normal, the occluder leans over the surface.
    bool over = slice.facing * aside < lean * lift;
    float part = segment(height);
    float below = 0.5 * slice.facing * height * height + lean * (over ? 1.5707963268 - part : part);
    float weight = max(0.0, 1.0 - squared / (radius * radius));
    horizon += max(0.0, below - horizon.y) * vec2(weight, min(1.0, weight / OUTER));
}

float occluded(ivec2 block, ivec2 pixel, float depth, vec2 slopes) {
    float radius = occlusion_radius();
    // Unit: the width of a pixel at the surface.
    vec3 x = view.ray_hi[0].xyz / ((PERSPECTIVE ? view.near : view.key_slope) * frame.pixel_width);
    vec3 y = view.ray_hi[1].xyz / ((PERSPECTIVE ? view.near : view.key_slope) * frame.pixel_width);
    vec3 ray = ray_step(vec2(pixel) + 0.5), to_eye = -normalize(ray);
    vec3 normal = normalize(slopes.x * cross(y, ray) + slopes.y * cross(ray, x) + cross(x, y));
    normal = dot(normal, to_eye) < 0.0 ? -normal : normal;
    float area = abs(dot(cross(x, y), to_eye));
    int direction = (((block.x + block.y) & 3) << 2) + (block.x & 3);
    float jitter = (float((block.y - block.x) & 3) + 0.5) / 4.0;
    // Neighbouring pixels show the steps between splats, too.
    float first = max(2.0, radius / 32.0);
    vec2 along = DIRECTIONS[direction];
    float sum = 0.0;
    for (int k = 0; k < SLICES; k++) {
        vec3 across = along.x * x + along.y * y;
        across -= dot(across, to_eye) * to_eye;
        float squared = dot(across, across), facing = max(dot(normal, to_eye), 1e-6);
        across *= inversesqrt(squared);
        float leaning = dot(normal, across);
        Slice slice = Slice(across, facing, leaning, inversesqrt(facing * facing + leaning * leaning));
        vec2 horizons[2] = vec2[](vec2(0.0), vec2(0.0));
        for (int i = 0; i < STEPS; i++) {
            // Exactly as the reference computes them: rounding decides which pixel is read.
            precise float part = (float(i) + jitter) / float(STEPS);
            precise float distance = first + (radius - first) * part * part;
            precise vec2 at = along * distance + 0.5;
            ivec2 step = ivec2(floor(at));
            for (int side = -1; side <= 1; side += 2) {
                float other = depth_at(pixel + side * step);
                if (!(other > 0.0)) continue;
                vec2 px = vec2(side * step);
                float scale = PERSPECTIVE ? other / depth : 1.0;
                vec3 offset = scale * (px.x * x + px.y * y - rise(depth, other) * ray);
                add(horizons[side < 0 ? 0 : 1], offset, float(side), slice, normal, radius);
            }
        }
        // Slices are evenly spaced on the screen, and not around the ray.
        sum += area / squared * (horizons[0].x + horizons[1].x);
        along = vec2(-along.y, along.x);
    }
    return sum / float(SLICES);
}

void main() {
    ivec2 block = invocation_pixel();
    if (any(greaterThanEqual(block, (picture_size() + 1) / 2))) return;
    ivec2 pixel = sampled_pixel(block);
    float depth = depth_at(pixel);
    vec4 values = vec4(0.0);
    if (depth > 0.0) {
        vec2 slopes = vec2(slope(pixel, ivec2(1, 0), depth), slope(pixel, ivec2(0, 1), depth));
        values = vec4(occluded(block, pixel, depth, slopes), depth, slopes);
    }
    imageStore(occlusion, block, values);
}

#endif
