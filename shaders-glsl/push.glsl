// Push: a pixel of the finer level from the coarser pixels around it and from its neighbours (marroquim2008 §3.3).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pyramid.glsl"
#include "lib/camera_rays.glsl"

PYRAMID(3, from, readonly)
DEFINE_LOAD(from)
PYRAMID(2, to, )
DEFINE_LOAD(to)
DEFINE_STORE(to)

layout(constant_id = 32) const bool PING_PONG = false; // both pyramids alternate by level

// Widening of a disc's variance on level 0, px²; four times as much per level. Narrower discs leave holes.
const float WIDENING = 0.25;
// Negated ln of the weight at a disc's rim: σ is a third of the radius; half of it as published.
const float RIM = 4.5, PAPER_RIM = 2.0;

// Widening of the covariance of the discs around a pixel, px²: discs within an eighth of a pixel do not define a texture's gradient.
const float SPREAD = 1.0 / 64.0;
// Relative widening, so that discs along a line define a gradient along it only.
const float ALONG = 1.0 / 4096.0;

// Candidate k for a pixel: the four nearest coarser pixels, then the pixel and its neighbours, row by row. Its displacement is relative to
// the pixel's centre.
Sample candidate(int k, uint level, uint start, uint coarser_start, ivec2 pixel) {
    bool coarse = k < 4;
    uint from_level = coarse ? level + 1 : level;
    ivec2 step = 2 * (pixel & 1) - 1;
    ivec2 neighbour = coarse ? pixel / 2 + step * ivec2(k & 1, k >> 1) : pixel + ivec2((k - 4) % 3, (k - 4) / 3) - 1;
    if (from_level >= pass.levels) return NO_SAMPLE;
    // Outside the level, a valid pixel is loaded and ignored: all lanes load.
    bool inside = is_within(from_level, neighbour);
    ivec2 valid = inside ? neighbour : coarse ? pixel / 2 : pixel;
    Sample s = NO_SAMPLE;
    // With ping-pong, the pyramid that is read holds the final coarser level and a copy of this one.
    if (coarse && !PING_PONG) s = load_to(sample_index(from_level, coarser_start, valid));
    else s = load_from(sample_index(from_level, coarse ? coarser_start : start, valid));
    if (!inside) s = NO_SAMPLE;
    // Integer offsets keep the digits that differences of screen positions lose.
    s.displacement += (coarse ? vec2(2 * neighbour - pixel) + 0.5 : vec2(neighbour - pixel)) * float(1u << level);
    return s;
}

void main() {
    uint level = pass.level;
    ivec2 pixel = invocation_pixel(level);
    if (pixel.x < 0) return;
    vec2 centre = level_centre(level, pixel);
    uint start = level_start(level), coarser_start = level_start(level + 1);
    float widening = PAPER ? 0.0 : WIDENING * float(1u << (2 * level));
    int count = PAPER ? 4 : 13;

    Sample point = load_from(sample_index(level, start, pixel));
    // The front disc decides which others are of its surface: the nearest; as published, the one of greatest weight.
    Sample front = NO_SAMPLE;
    float weights[13], best = PAPER ? 0.0 : -1e38;
    for (int k = 0; k < count; k++) {
        Sample s = candidate(k, level, start, coarser_start, pixel);
        float m2 = radii2(s, centre + s.displacement, -s.displacement, widening);
        bool covers = s.near > 0.0 && m2 <= 1.0;
        weights[k] = covers ? exp(-(PAPER ? PAPER_RIM : RIM) * m2) : 0.0;
        float priority = PAPER ? weights[k] : -s.near;
        if (covers && priority > best) {
            best = priority;
            front = s;
        }
    }
    // On the finest level a point is visible if its disc covers the pixel's centre; otherwise it only contributes to others.
    if (!PAPER && level == 0 && weights[8] == 0.0) point.near = 0.0;

    Sample mean = NO_SAMPLE;
    float total = 0.0, greatest = 0.0;
    // Mean displacement from the front's, and second moments of displacements and coordinates.
    vec2 sum = vec2(0.0);
    vec3 squares = vec3(0.0);
    vec2 x_products = vec2(0.0), y_products = vec2(0.0);
    for (int k = 0; k < (front.near > 0.0 ? count : 0); k++) {
        Sample s = candidate(k, level, start, coarser_start, pixel);
        float w = (PAPER || s.near <= front.far) && s.tube == front.tube ? weights[k] : 0.0;
        total += w;
        mean.near += w * s.near;
        mean.far += w * s.far;
        // Discs store the depth of their centres; the picture shows the depth at the pixel's centre. Tubes store the depth of their axes.
        mean.depth += w * (!PAPER && level == 0 && !s.tube ? depth_at(s, centre + s.displacement, -s.displacement) : s.depth);
        mean.radius += w * s.radius;
        mean.displacement += w * s.displacement;
        mean.normal += w * aligned_direction(s, front);
        mean.colour += w * s.colour;
        vec2 displacement = s.displacement - front.displacement, offset = coordinate_offset(s, front);
        mean.coordinates += w * offset;
        sum += w * displacement;
        squares += w * vec3(displacement.x * displacement.x, displacement.x * displacement.y, displacement.y * displacement.y);
        x_products += w * displacement.x * offset;
        y_products += w * displacement.y * offset;
        if (w > greatest) {
            greatest = w;
            mean.id = s.id;
        }
    }
    if (total > 0.0) {
        mean.tube = front.tube;
        mean.near /= total;
        mean.far /= total;
        mean.depth /= total;
        mean.radius /= total;
        mean.displacement /= total;
        mean.normal = dot(mean.normal, mean.normal) > 0.0 ? normalize(mean.normal) : vec3(0.0);
        mean.colour /= total;
        mean.coordinates /= total;
        if (TEXTURE && !PAPER && level == 0) {
            // To first order, by least squares: a mean would give the coordinates at the mean of the discs' centres.
            vec2 m = mean.displacement, d = sum / total;
            vec3 c = squares / total - vec3(d.x * d.x, d.x * d.y, d.y * d.y);
            c.xz += SPREAD + ALONG * (c.x + c.z);
            vec2 x = x_products / total - d.x * mean.coordinates, y = y_products / total - d.y * mean.coordinates;
            mean.coordinates -= ((x * c.z - y * c.y) * m.x + (y * c.x - x * c.y) * m.y) / (c.x * c.z - c.y * c.y);
        }
        mean.coordinates += front.coordinates;
    }
    bool has_point = point.near > 0.0, has_mean = total > 0.0;
    if (PAPER) {
        // Hidden if behind the coarser pixel that contains it.
        Sample parent = candidate(0, level, start, coarser_start, pixel);
        bool hidden = parent.near > 0.0 && point.near > parent.far;
        if (!has_point || hidden) point = mean;
    } else if (!has_point || has_mean && point.near > mean.far) {
        point = mean;
    } else if (level == 0 && has_mean && mean.near <= point.far && mean.tube == point.tube) {
        // The surface of a tube is computed from its axis, whose depth is that of the disc's centre.
        if (point.tube) {
            point.displacement = mean.displacement;
            point.radius = mean.radius;
        }
        point.colour = mean.colour;
        point.coordinates = mean.coordinates;
        point.normal = mean.normal;
        point.depth = mean.depth;
    }
    store_to(sample_index(level, start, pixel), point);
}

#endif
