// Pull: a coarser pixel is the mean of the discs below it that are in front and cover its centre (marroquim2008 §3.2).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pyramid.glsl"
#include "lib/lens.glsl"

PYRAMID(3, from, readonly)
LOADED(from)
PYRAMID(2, to, writeonly)
STORED(to)

void main() {
    uint level = pass.level, finer = level - 1;
    ivec2 at = own_pixel(level);
    if (at.x < 0) return;
    vec2 own = level_centre(level, at);
    uint start = level_start(finer);

    Sample below[4];
    float nearest = 1e38;
    int front = 0;
    for (int k = 0; k < 4; k++) {
        ivec2 child = 2 * at + ivec2(k & 1, k >> 1);
        bool there = is_within(finer, child);
        below[k] = load_from(there ? place_in(finer, start, child) : 0);
        if (!there) below[k].near = 0.0;
        // From whole numbers: a difference of positions on the picture would lose digits.
        vec2 e = (vec2(child - 2 * at) - 0.5) * float(1u << finer) + below[k].displacement;
        below[k].displacement = e;
        bool counts = below[k].near > 0.0 && radii2(below[k], own + e, -e, 0.0) <= 1.0;
        if (!counts) {
            below[k].near = 0.0;
        } else if (below[k].near < nearest) {
            nearest = below[k].near;
            front = k;
        }
    }
    Sample mean = NOTHING;
    float count = 0.0, nearest_centre = 1e38;
    for (int k = 0; k < 4; k++) {
        Sample s = below[k];
        // One surface, and as the nearest is of a tube or of none.
        if (s.near == 0.0 || s.near > below[front].far || s.tube != below[front].tube) continue;
        count += 1.0;
        mean.far = max(mean.far, s.far);
        mean.depth += s.depth;
        mean.radius += s.radius;
        mean.displacement += s.displacement;
        mean.normal += direction_as(s, below[front]);
        mean.colour += s.colour;
        mean.coordinates += turn_from(s, below[front]);
        float centre = dot(s.displacement, s.displacement);
        if (centre < nearest_centre) {
            nearest_centre = centre;
            mean.id = s.id;
        }
    }
    if (count > 0.0) {
        mean.near = nearest;
        mean.tube = below[front].tube;
        mean.depth /= count;
        mean.radius /= count;
        mean.displacement /= count;
        mean.normal = dot(mean.normal, mean.normal) > 0.0 ? normalize(mean.normal) : vec3(0.0);
        mean.colour /= count;
        mean.coordinates = below[front].coordinates + mean.coordinates / count;
    }
    store_to(place_in(level, level_start(level), at), mean);
}

#endif
