// Pull: a pixel of the coarser level is the mean of the front discs of the four finer pixels that cover its centre (marroquim2008 §3.2).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pyramid.glsl"
#include "lib/camera_rays.glsl"

PYRAMID(3, from, readonly)
DEFINE_LOAD(from)
PYRAMID(2, to, writeonly)
DEFINE_STORE(to)

void main() {
    uint level = pass.level, finer = level - 1;
    ivec2 pixel = invocation_pixel(level);
    if (pixel.x < 0) return;
    vec2 centre = level_centre(level, pixel);
    uint start = level_start(finer);

    Sample finer_samples[4];
    float nearest = 1e38;
    int front = 0;
    for (int k = 0; k < 4; k++) {
        ivec2 child = 2 * pixel + ivec2(k & 1, k >> 1);
        bool inside = is_within(finer, child);
        finer_samples[k] = load_from(inside ? sample_index(finer, start, child) : 0);
        if (!inside) finer_samples[k].near = 0.0;
        // Integer offsets keep the digits that differences of screen positions lose.
        vec2 e = (vec2(child - 2 * pixel) - 0.5) * float(1u << finer) + finer_samples[k].displacement;
        finer_samples[k].displacement = e;
        bool covers = finer_samples[k].near > 0.0 && radii2(finer_samples[k], centre + e, -e, 0.0) <= 1.0;
        if (!covers) {
            finer_samples[k].near = 0.0;
        } else if (finer_samples[k].near < nearest) {
            nearest = finer_samples[k].near;
            front = k;
        }
    }
    Sample mean = NO_SAMPLE;
    float count = 0.0, least_distance2 = 1e38;
    for (int k = 0; k < 4; k++) {
        Sample s = finer_samples[k];
        // Only discs of the front surface, and tubes or non-tubes as the front is.
        if (s.near == 0.0 || s.near > finer_samples[front].far || s.tube != finer_samples[front].tube) continue;
        count += 1.0;
        mean.far = max(mean.far, s.far);
        mean.depth += s.depth;
        mean.radius += s.radius;
        mean.displacement += s.displacement;
        mean.normal += aligned_direction(s, finer_samples[front]);
        mean.colour += s.colour;
        mean.coordinates += coordinate_offset(s, finer_samples[front]);
        float distance2 = dot(s.displacement, s.displacement);
        if (distance2 < least_distance2) {
            least_distance2 = distance2;
            mean.id = s.id;
        }
    }
    if (count > 0.0) {
        mean.near = nearest;
        mean.tube = finer_samples[front].tube;
        mean.depth /= count;
        mean.radius /= count;
        mean.displacement /= count;
        mean.normal = dot(mean.normal, mean.normal) > 0.0 ? normalize(mean.normal) : vec3(0.0);
        mean.colour /= count;
        mean.coordinates = finer_samples[front].coordinates + mean.coordinates / count;
    }
    store_to(sample_index(level, level_start(level), pixel), mean);
}

#endif
