// Reconstruction of a sample of the finer level from the coarser samples around it and from its neighbours (marroquim2008 §3.3).

#include "lib/beside.glsl"

layout(constant_id = 32) const bool PING_PONG = false; // both pyramids alternate by level

layout(constant_id = 65) const bool BOX_WEIGHTS = false; // of discs, by the published rules: 1 up to the rim

// Widening of a disc's variance on level 0, px²; four times as much per level. Narrower discs leave holes.
const float WIDENING = 0.25;
// On level 0, further widening of discs of a radius of one pixel, px²; none from two pixels on. Their points leave some pixels empty.
const float WIDENING_OF_SMALL = 0.15;
// Negated ln of the weight at a disc's rim: σ is a third of the radius; half of it as published.
const float RIM = 4.5, PAPER_RIM = 2.0;

// Widening of the covariance of the discs around a pixel, px²: discs within an eighth of a pixel do not define a texture's gradient.
const float SPREAD = 1.0 / 64.0;
// Relative widening, so that discs along a line define a gradient along it only.
const float ALONG = 1.0 / 4096.0;

// Candidates of a pixel: the four nearest coarser pixels, then the pixel and its neighbours, row by row.
const uint COARSER = 4, CANDIDATES = PAPER ? 4 : 13;

// What push accumulates of the candidates of a pixel. Mean displacements and coordinates are relative to those of `front`.
struct Sums {
    Sample front;   // the front disc decides which others are of its surface
    float priority; // of the front disc
    float facing;   // distance of the nearest disc that faces the eye, of those that cover the pixel's centre
    vec2 beside;    // on level 0, the least and the greatest of those that face the eye in the pixel and its neighbours
    Sample mean;    // weighted sums
    float total, greatest;
    vec2 displacement;
    vec3 squares;   // second moments of displacements
    vec2 x_products, y_products; // and of displacements and coordinates
};

// Zeros instead of the undefined words of an empty sample: a clear writes the first image only.
Sample without_undefined_words(Sample s) {
    bool empty = s.near == 0.0;
    s.far = empty ? 0.0 : s.far;
    s.depth = empty ? 0.0 : s.depth;
    s.normal = empty ? vec3(0.0) : s.normal;
    s.colour = empty ? vec3(0.0) : s.colour;
    s.coordinates = empty ? vec2(0.0) : s.coordinates;
    return s;
}

// Candidate k of a pixel. Its displacement is relative to the pixel's centre.
Sample candidate(uint k, ivec2 pixel) {
    bool coarser = k < COARSER;
    // Nothing is coarser than the top level.
    if (coarser && pass.adjacent_size.x == 0) return NO_SAMPLE;
    ivec2 step = 2 * (pixel & 1) - 1;
    ivec2 from_pixel = coarser ? pixel / 2 + step * ivec2(k & 1, k >> 1) : pixel + ivec2((k - 4) % 3, (k - 4) / 3) - 1;
    ivec2 size = coarser ? pass.adjacent_size : pass.size;
    // Beyond the level, a pixel of it is loaded and ignored: all lanes load.
    ivec2 texel = (coarser ? pass.adjacent_origin : pass.from_origin) + clamp(from_pixel, ivec2(0), max(size - 1, 0));
    Sample s = NO_SAMPLE;
    // With ping-pong, the pyramid that is read holds the final coarser level and a copy of this one.
    if (coarser && !PING_PONG) s = load_final(texel);
    else s = load_from(texel);
    s = without_undefined_words(s);
    if (!is_within(size, from_pixel)) s.near = 0.0;
    // Integer offsets keep the digits that differences of screen positions lose.
    s.displacement += (coarser ? vec2(2 * from_pixel - pixel) + 0.5 : vec2(from_pixel - pixel)) * float(1u << pass.level);
    return s;
}

// Weight of a candidate for the pixel with this centre, 0 if its disc does not cover that.
float weight_of(Sample s, vec2 centre, float widening, inout Sums sums) {
    if (!PAPER && pass.level == 0) widening += WIDENING_OF_SMALL * clamp(2.0 - s.radius, 0.0, 1.0);
    float m2 = radii2(s, centre + s.displacement, -s.displacement, widening);
    bool covers = s.near > 0.0 && m2 <= 1.0;
    sums.facing = min(sums.facing, facing_distance(s, covers));
    return covers ? exp(-(PAPER ? PAPER_RIM : RIM) * m2) : 0.0;
}

// Whether a disc of level 0 is the surface that faces the eye beside it, past an outline.
bool is_past_outline(Sample s, vec2 beside) {
    if (!CULL_AUTO || pass.level > 0 || !s.back) return false;
    float width = (PERSPECTIVE ? from_eye(s.near) : 1.0) / focal_scale(), least = s.near - BEHIND_BESIDE * sqrt(max(s.radius, 1.0)) * width;
    return beside.x >= least && beside.x <= s.far || beside.y >= least && beside.y <= s.far;
}

void find_beside(Sample s, inout Sums sums) {
    if (!CULL_AUTO || pass.level > 0 || s.near == 0.0 || s.back) return;
    sums.beside = vec2(min(sums.beside.x, s.near), max(sums.beside.y, s.near));
}

// Finds the front disc: the nearest of those that cover the pixel's centre, without the far side; as published, the one of greatest Gaussian weight.
void find_front(Sample s, inout float weight, inout Sums sums) {
    if (is_far_side(s, sums.facing) || is_past_outline(s, sums.beside)) weight = 0.0;
    float priority = PAPER ? weight : -s.near;
    if (weight > 0.0 && priority > sums.priority) {
        sums.priority = priority;
        sums.front = s;
    }
    if (PAPER && BOX_WEIGHTS && weight > 0.0) weight = 1.0;
}

// Adds a candidate of weight `w`, if it is of the front surface.
void add(Sample s, float w, vec2 centre, inout Sums sums) {
    if (!PAPER && s.near > sums.front.far || s.tube != sums.front.tube) w = 0.0;
    sums.total += w;
    sums.mean.near += w * s.near;
    sums.mean.far += w * s.far;
    // Discs store the depth of their centres; the picture shows the depth at the pixel's centre. Tubes store the depth of their axes.
    sums.mean.depth += w * (!PAPER && pass.level == 0 && !s.tube ? depth_at(s, centre + s.displacement, -s.displacement) : s.depth);
    sums.mean.radius += w * s.radius;
    sums.mean.displacement += w * s.displacement;
    sums.mean.normal += w * aligned_direction(s, sums.front);
    sums.mean.colour += w * s.colour;
    vec2 displacement = s.displacement - sums.front.displacement, offset = coordinate_offset(s, sums.front);
    sums.mean.coordinates += w * offset;
    sums.displacement += w * displacement;
    sums.squares += w * vec3(displacement.x * displacement.x, displacement.x * displacement.y, displacement.y * displacement.y);
    sums.x_products += w * displacement.x * offset;
    sums.y_products += w * displacement.y * offset;
    // Box weights are equal: the front disc has the id.
    if (BOX_WEIGHTS ? w > 0.0 && s.id == sums.front.id : w > sums.greatest) {
        sums.greatest = w;
        sums.mean.id = s.id;
    }
}

// Mean of the accumulated candidates; no sample if there are none.
Sample mean_of(Sums sums) {
    Sample mean = sums.mean;
    if (!(sums.total > 0.0)) return NO_SAMPLE;
    mean.tube = sums.front.tube;
    mean.subpixel = sums.front.subpixel;
    mean.back = sums.front.back;
    mean.near /= sums.total;
    mean.far /= sums.total;
    mean.depth /= sums.total;
    mean.radius /= sums.total;
    mean.displacement /= sums.total;
    mean.normal = dot(mean.normal, mean.normal) > 0.0 ? normalize(mean.normal) : vec3(0.0);
    mean.colour /= sums.total;
    mean.coordinates /= sums.total;
    if (TEXTURE && !PAPER && pass.level == 0) {
        // To first order, by least squares: a mean would give the coordinates at the mean of the discs' centres.
        vec2 m = mean.displacement, d = sums.displacement / sums.total;
        vec3 c = sums.squares / sums.total - vec3(d.x * d.x, d.x * d.y, d.y * d.y);
        c.xz += SPREAD + ALONG * (c.x + c.z);
        vec2 x = sums.x_products / sums.total - d.x * mean.coordinates, y = sums.y_products / sums.total - d.y * mean.coordinates;
        mean.coordinates -= ((x * c.z - y * c.y) * m.x + (y * c.x - x * c.y) * m.y) / (c.x * c.z - c.y * c.y);
    }
    mean.coordinates += sums.front.coordinates;
    return mean;
}

// Extent of points around a pixel's centre along x, y and the diagonals, px.
struct Surroundings {
    vec4 least, most;
};

void surround(Sample s, vec2 beside, inout Surroundings around) {
    if (is_past_outline(s, beside)) s.near = 0.0;
    vec4 along = vec4(s.displacement, s.displacement.x + s.displacement.y, s.displacement.x - s.displacement.y);
    around.least = s.near > 0.0 ? min(around.least, along) : around.least;
    around.most = s.near > 0.0 ? max(around.most, along) : around.most;
}

// Whether points are on all sides of the centre.
bool is_surrounded(Surroundings around) {
    return all(lessThanEqual(around.least, vec4(0.0))) && all(greaterThanEqual(around.most, vec4(0.0)));
}

// The final sample of a pixel of the level.
Sample reconstructed(ivec2 pixel) {
    vec2 centre = level_centre(pass.level, pixel);
    float widening = PAPER ? 0.0 : WIDENING * float(1u << (2 * pass.level));

    Sums sums = Sums(NO_SAMPLE, PAPER ? 0.0 : -1e38, NOT_FACING, vec2(NOT_FACING, 0.0), NO_SAMPLE, 0.0, 0.0, vec2(0.0), vec3(0.0), vec2(0.0), vec2(0.0));
    Sample samples[13];
    float weights[13];
    // Unrolled by hand: compilers unroll shorter bodies only, and arrays with a dynamic index are memory. On lavapipe a fetch costs more than
    // the registers; a GPU with few of them may prefer to fetch twice.
#define WEIGHT(K)                                                                  \
    if (K < CANDIDATES) {                                                            \
        samples[K] = candidate(K, pixel);                                          \
        weights[K] = weight_of(samples[K], centre, widening, sums);                \
        if (K >= COARSER) find_beside(samples[K], sums);                           \
    }
#define FRONT(K) if (K < CANDIDATES) find_front(samples[K], weights[K], sums);
#define ADD(K) if (K < CANDIDATES) add(samples[K], weights[K], centre, sums);
    WEIGHT(0) WEIGHT(1) WEIGHT(2) WEIGHT(3) WEIGHT(4) WEIGHT(5) WEIGHT(6) WEIGHT(7) WEIGHT(8) WEIGHT(9) WEIGHT(10) WEIGHT(11) WEIGHT(12)
    FRONT(0) FRONT(1) FRONT(2) FRONT(3) FRONT(4) FRONT(5) FRONT(6) FRONT(7) FRONT(8) FRONT(9) FRONT(10) FRONT(11) FRONT(12)
    ADD(0) ADD(1) ADD(2) ADD(3) ADD(4) ADD(5) ADD(6) ADD(7) ADD(8) ADD(9) ADD(10) ADD(11) ADD(12)
    // Discs that are widened to a pixel reach beyond the outline: there, a pixel is covered if points are on all sides of its centre. They may be
    // of any surface: on steep ones, the intervals of neighbouring points do not meet.
    if (!PAPER && pass.level == 0 && sums.front.subpixel) {
        Surroundings around = Surroundings(vec4(1e38), vec4(-1e38));
        surround(samples[4], sums.beside, around);
        surround(samples[5], sums.beside, around);
        surround(samples[6], sums.beside, around);
        surround(samples[7], sums.beside, around);
        surround(samples[8], sums.beside, around);
        surround(samples[9], sums.beside, around);
        surround(samples[10], sums.beside, around);
        surround(samples[11], sums.beside, around);
        surround(samples[12], sums.beside, around);
        if (!is_surrounded(around)) return NO_SAMPLE;
    }
    Sample mean = mean_of(sums), point;
    bool has_mean = mean.near > 0.0;
    if (PAPER) {
        point = load_from(pass.from_origin + pixel);
        // Hidden if behind the coarser pixel that contains it.
        bool hidden = samples[0].near > 0.0 && point.near > samples[0].far;
        return point.near == 0.0 || hidden ? mean : point;
    }
    point = samples[8];
    // On the finest level a point is visible if its disc covers the pixel's centre; otherwise it only contributes to others.
    if (pass.level == 0 && weights[8] == 0.0 || is_far_side(point, sums.facing)) point.near = 0.0;
    if (point.near == 0.0 || has_mean && point.near > mean.far) {
        point = mean;
    } else if (pass.level == 0 && has_mean && mean.near <= point.far && mean.tube == point.tube) {
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
    return point;
}
