// Pull: a pixel of the coarser level is the mean of the front discs of the four finer pixels that cover its centre (marroquim2008 §3.2).
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pixel_group.glsl"
#include "lib/pyramid.glsl"
#include "lib/level.glsl"
#include "lib/camera_rays.glsl"
#include "lib/occupied_tiles.glsl"

layout(constant_id = 32) const bool PING_PONG = false; // both pyramids alternate by level: all pixels are written

PYRAMID_TO_READ(3, from)
PYRAMID_TO_WRITE(2, to)

// Child k of a pixel, valid if its disc covers the pixel's centre. Its displacement is relative to that centre.
Sample child(int k, ivec2 pixel, vec2 centre) {
    ivec2 at = 2 * pixel + ivec2(k & 1, k >> 1);
    Sample s = load_from(pass.adjacent_origin + min(at, pass.adjacent_size - 1));
    // Integer offsets keep the digits that differences of screen positions lose.
    s.displacement += (vec2(k & 1, k >> 1) - 0.5) * float(1u << (pass.level - 1));
    bool covers = radii2(s, centre + s.displacement, -s.displacement, 0.0) <= 1.0;
    if (!covers || !is_within(pass.adjacent_size, at)) s.near = 0.0;
    return s;
}

struct Mean {
    Sample sum;
    float count, least_distance2;
};

// A child, unless it is of the far side of a surface that faces the eye at this distance.
Sample without_far_side(Sample s, float facing) {
    if (is_far_side(s, facing)) s.near = 0.0;
    return s;
}

// Adds a child, if it is of the front surface: a tube or not as the front is.
void add(Sample s, Sample front, inout Mean mean) {
    if (s.near == 0.0 || s.near > front.far || s.tube != front.tube) return;
    mean.count += 1.0;
    mean.sum.far = max(mean.sum.far, s.far);
    mean.sum.depth += s.depth;
    mean.sum.radius += s.radius;
    mean.sum.displacement += s.displacement;
    mean.sum.normal += aligned_direction(s, front);
    mean.sum.colour += s.colour;
    mean.sum.coordinates += coordinate_offset(s, front);
    float distance2 = dot(s.displacement, s.displacement);
    if (distance2 < mean.least_distance2) {
        mean.least_distance2 = distance2;
        mean.sum.id = s.id;
    }
}

Sample nearer(Sample a, Sample b) {
    return b.near > 0.0 && (a.near == 0.0 || b.near < a.near) ? b : a;
}

void main() {
    ivec2 pixel = !PING_PONG && pass.level < LISTED_LEVELS ? LISTED_PIXEL(occupied, pass.level) : invocation_pixel();
    if (!is_within(pass.size, pixel)) return;
    vec2 centre = level_centre(pass.level, pixel);
    Sample a = child(0, pixel, centre), b = child(1, pixel, centre), c = child(2, pixel, centre), d = child(3, pixel, centre);
    if (CULL_AUTO) {
        float facing = min(min(facing_distance(a, a.near > 0.0), facing_distance(b, b.near > 0.0)),
                           min(facing_distance(c, c.near > 0.0), facing_distance(d, d.near > 0.0)));
        a = without_far_side(a, facing);
        b = without_far_side(b, facing);
        c = without_far_side(c, facing);
        d = without_far_side(d, facing);
    }
    Sample front = nearer(nearer(nearer(a, b), c), d);
    Mean of_front = Mean(NO_SAMPLE, 0.0, 1e38);
    add(a, front, of_front);
    add(b, front, of_front);
    add(c, front, of_front);
    add(d, front, of_front);
    Sample mean = of_front.sum;
    if (of_front.count > 0.0) {
        mean.near = front.near;
        mean.tube = front.tube;
        mean.subpixel = front.subpixel;
        mean.back = front.back;
        mean.depth /= of_front.count;
        mean.radius /= of_front.count;
        mean.displacement /= of_front.count;
        mean.normal = dot(mean.normal, mean.normal) > 0.0 ? normalize(mean.normal) : vec3(0.0);
        mean.colour /= of_front.count;
        mean.coordinates = front.coordinates + mean.coordinates / of_front.count;
    }
    store_to(pass.to_origin + pixel, mean);
}

#endif
