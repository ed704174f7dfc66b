// Push: a finer pixel from the coarser ones about it and from its neighbours (marroquim2008 §3.3).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pyramid.glsl"
#include "lib/lens.glsl"

PYRAMID(3, from, readonly)
LOADED(from)
PYRAMID(2, to, )
LOADED(to)
STORED(to)

layout(constant_id = 32) const bool PING_PONG = false; // levels are kept in turns

// What a disc's variance is widened by on level 0, px²; four times as much a level. Narrower ones leave holes between themselves.
const float WIDENING = 0.25;
// ln of the weight at a disc's rim, negated: σ is a third of the radius; half of it as published.
const float RIM = 4.5, PAPER_RIM = 2.0;

// What the spread of the discs about a pixel is widened by, px²: a texture's gradient is not told from what is nearer than an eighth of a
// pixel.
const float SPREAD = 1.0 / 64.0;
// And by this part of itself, so that what lies along a line has a gradient along it alone.
const float ALONG = 1.0 / 4096.0;

// Candidate k for pixel `at`: the four nearest coarser pixels, then the pixel and its neighbours, row by row. Its displacement is from `own`.
Sample candidate(int k, uint level, uint start, uint above, ivec2 at) {
    bool coarse = k < 4;
    uint of = coarse ? level + 1 : level;
    ivec2 side = 2 * (at & 1) - 1;
    ivec2 place = coarse ? at / 2 + side * ivec2(k & 1, k >> 1) : at + ivec2((k - 4) % 3, (k - 4) / 3) - 1;
    if (of >= pass.levels) return NOTHING;
    // Beyond the border the pixel's own place is read, and forgotten: all lanes read.
    bool there = is_within(of, place);
    ivec2 known = there ? place : coarse ? at / 2 : at;
    Sample s = NOTHING;
    // In turns, what is final on the coarser level lies beside what was copied of this one.
    if (coarse && !PING_PONG) s = load_to(place_in(of, above, known));
    else s = load_from(place_in(of, coarse ? above : start, known));
    if (!there) s = NOTHING;
    // From whole numbers: a difference of positions on the picture would lose digits.
    s.displacement += (coarse ? vec2(2 * place - at) + 0.5 : vec2(place - at)) * float(1u << level);
    return s;
}

void main() {
    uint level = pass.level;
    ivec2 at = own_pixel(level);
    if (at.x < 0) return;
    vec2 own = level_centre(level, at);
    uint start = level_start(level), above = level_start(level + 1);
    float widening = PAPER ? 0.0 : WIDENING * float(1u << (2 * level));
    int count = PAPER ? 4 : 13;

    Sample point = load_from(place_in(level, start, at));
    // The one that decides which others are its surface: the nearest; as published, of which kind, by the greatest weight.
    Sample front = NOTHING;
    float weights[13], first = PAPER ? 0.0 : -1e38;
    for (int k = 0; k < count; k++) {
        Sample s = candidate(k, level, start, above, at);
        float m2 = radii2(s, own + s.displacement, -s.displacement, widening);
        bool counts = s.near > 0.0 && m2 <= 1.0;
        weights[k] = counts ? exp(-(PAPER ? PAPER_RIM : RIM) * m2) : 0.0;
        float rank = PAPER ? weights[k] : -s.near;
        if (counts && rank > first) {
            first = rank;
            front = s;
        }
    }
    // On the finest level a point is seen where its disc covers the pixel's centre; elsewhere it is a source alone.
    if (!PAPER && level == 0 && weights[8] == 0.0) point.near = 0.0;

    Sample mean = NOTHING;
    float total = 0.0, most = 0.0;
    // Displacements from the front's, and products of these, and of these and coordinates.
    vec2 apart = vec2(0.0);
    vec3 spread = vec3(0.0);
    vec2 by_x = vec2(0.0), by_y = vec2(0.0);
    for (int k = 0; k < (front.near > 0.0 ? count : 0); k++) {
        Sample s = candidate(k, level, start, above, at);
        float w = (PAPER || s.near <= front.far) && s.tube == front.tube ? weights[k] : 0.0;
        total += w;
        mean.near += w * s.near;
        mean.far += w * s.far;
        // Discs carry the depths of their centres; a pixel of the picture shows that of its own. Tubes carry those of their axes.
        mean.depth += w * (!PAPER && level == 0 && !s.tube ? depth_at(s, own + s.displacement, -s.displacement) : s.depth);
        mean.radius += w * s.radius;
        mean.displacement += w * s.displacement;
        mean.normal += w * direction_as(s, front);
        mean.colour += w * s.colour;
        vec2 e = s.displacement - front.displacement, turn = turn_from(s, front);
        mean.coordinates += w * turn;
        apart += w * e;
        spread += w * vec3(e.x * e.x, e.x * e.y, e.y * e.y);
        by_x += w * e.x * turn;
        by_y += w * e.y * turn;
        if (w > most) {
            most = w;
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
            // To first order, by least squares: a mean would be that at the mean of the discs' centres.
            vec2 m = mean.displacement, d = apart / total;
            vec3 c = spread / total - vec3(d.x * d.x, d.x * d.y, d.y * d.y);
            c.xz += SPREAD + ALONG * (c.x + c.z);
            vec2 x = by_x / total - d.x * mean.coordinates, y = by_y / total - d.y * mean.coordinates;
            mean.coordinates -= ((x * c.z - y * c.y) * m.x + (y * c.x - x * c.y) * m.y) / (c.x * c.z - c.y * c.y);
        }
        mean.coordinates += front.coordinates;
    }
    bool known = point.near > 0.0, made = total > 0.0;
    if (PAPER) {
        // Behind is what is behind the coarser pixel that holds it.
        Sample holder = candidate(0, level, start, above, at);
        bool behind = holder.near > 0.0 && point.near > holder.far;
        if (!known || behind) point = mean;
    } else if (!known || made && point.near > mean.far) {
        point = mean;
    } else if (level == 0 && made && mean.near <= point.far && mean.tube == point.tube) {
        // What is seen of a tube is told from its axis, whose depth is that of the disc's centre.
        if (point.tube) {
            point.displacement = mean.displacement;
            point.radius = mean.radius;
        }
        point.colour = mean.colour;
        point.coordinates = mean.coordinates;
        point.normal = mean.normal;
        point.depth = mean.depth;
    }
    store_to(place_in(level, start, at), point);
}

#endif
