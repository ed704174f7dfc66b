// Pyramids of samples: a pixel of a level stores a disc of the surface (marroquim2008 §3). A pixel of level l covers 2^l × 2^l pixels of
// the viewport; screen lengths are viewport pixels on all levels.

layout(constant_id = 33) const bool COMPACT = false;           // samples are rounded to 24 bytes
layout(constant_id = 34) const bool UNBOUNDED_COLOURS = false; // some colours may be above 1
layout(constant_id = 38) const bool TEXTURE = false;           // samples have texture coordinates instead of colours
layout(constant_id = 39) const bool IDS = false;               // samples have point ids
layout(constant_id = 35) const bool TUBES = false;             // samples may be of tubes
layout(constant_id = 68) const bool CULL_AUTO = false;         // the sides of surfaces are found

#include "lib/sums.glsl"
#include "lib/compact.glsl"

// Words of a sample, and the images that store them: four words a texel, then one.
const uint COLOUR_WORDS = TEXTURE ? 2 : !SUM_COLOURS ? 0 : COMPACT ? 1 : 3;
const uint ID_WORD = (COMPACT ? 5 : 9) + COLOUR_WORDS, WORDS = ID_WORD + (IDS ? 1 : 0);
const uint QUADS = (WORDS + 1) / 4;
const uint SINGLES = 4 * QUADS < WORDS ? WORDS - 4 * QUADS : 0;

// Id of empty samples.
const uint NOBODY = 0xffffffffu;

struct Sample {
    float near;        // least distance of the surface; 0 if the sample is empty
    float far;         // greatest distance of samples of the same surface
    float depth;       // distance of the disc's centre
    float radius;      // of the disc seen face-on, px
    vec2 displacement; // of the disc's centre from the pixel's, px
    vec3 normal;       // world space; of a tube, the tangent
    vec3 colour;       // linear
    bool tube;         // of a tube: the disc faces the eye, around a point of the axis
    bool subpixel;     // of a point whose own disc is smaller: see LEAST_RADIUS
    bool back;         // faces away from the eye, with CULL_AUTO
    vec2 coordinates;  // of the disc's centre in the texture
    uint id;           // id of the point, or of the nearest of those that were averaged
};

const Sample NO_SAMPLE = Sample(0.0, 0.0, 0.0, 0.0, vec2(0.0), vec3(0.0), vec3(0.0), false, false, false, vec2(0.0), NOBODY);

// Normal or tangent, oriented like that of `other`: a tangent has no sign.
vec3 aligned_direction(Sample s, Sample other) {
    return s.tube && dot(s.normal, other.normal) < 0.0 ? -s.normal : s.normal;
}

// Texture coordinates relative to those of `other`, by the shortest way: the texture repeats.
vec2 coordinate_offset(Sample s, Sample other) {
    vec2 offset = s.coordinates - other.coordinates;
    return offset - floor(offset + 0.5);
}

// Distance of a surface that faces the eye, where there is none.
const float NOT_FACING = 1e38;

// The distance of a disc if it faces the eye.
float facing_distance(Sample s, bool covers) {
    return CULL_AUTO && covers && !s.back ? s.near : NOT_FACING;
}

// Whether a disc is of the far side of the surface that faces the eye at this distance, which hides it, or is behind it by no more than surfaces
// are thick.
bool is_far_side(Sample s, float facing) {
    return CULL_AUTO && s.back && facing <= s.far;
}

// A sample's words, as the images of a pyramid store them (src/frame/pyramids.rs).
//
//     full      near, radius, displacement x y, normal x y z, far, depth, colour r g b or coordinates u v, id
//     compact   near, displacement, radius and far − near, normal, depth, colour or coordinates u v, id
//
// The radius of a tube's sample is stored negated, and so is `near` of a subpixel one, and the depth of one that faces away.
struct Words {
    uvec4 quads[3];
    uint singles[2];
};

void set_word(inout Words words, uint at, uint word) {
    if (at < 4 * QUADS) words.quads[at / 4][at % 4] = word;
    else words.singles[at - 4 * QUADS] = word;
}

uint get_word(Words words, uint at) {
    return at < 4 * QUADS ? words.quads[min(at / 4, 2)][at % 4] : words.singles[at - min(4 * QUADS, at)];
}

Words pack_sample(Sample s) {
    Words words = Words(uvec4[3](uvec4(0), uvec4(0), uvec4(0)), uint[2](0, 0));
    float radius = s.tube ? -s.radius : s.radius, near = s.subpixel ? -s.near : s.near, depth = s.back ? -abs(s.depth) : s.depth;
    uvec3 colour = floatBitsToUint(TEXTURE ? vec3(s.coordinates, 0.0) : s.colour);
    if (COMPACT) {
        uint size = pack_halves(vec2(radius, 0.0)) | pack_length(max(s.far - s.near, 0.0)) << 16;
        words.quads[0] = uvec4(floatBitsToUint(near), pack_halves(s.displacement), size, pack_direction(s.normal));
        set_word(words, 4, floatBitsToUint(depth));
        if (!TEXTURE) colour.x = UNBOUNDED_COLOURS ? pack_shared(s.colour) : pack_roots(s.colour);
    } else {
        words.quads[0] = floatBitsToUint(vec4(near, radius, s.displacement));
        words.quads[1] = floatBitsToUint(vec4(s.normal, s.far));
        set_word(words, 8, floatBitsToUint(depth));
    }
    const uint first = ID_WORD - COLOUR_WORDS;
    if (COLOUR_WORDS > 0) set_word(words, first, colour.x);
    if (COLOUR_WORDS > 1) set_word(words, first + 1, colour.y);
    if (COLOUR_WORDS > 2) set_word(words, first + 2, colour.z);
    if (IDS) set_word(words, ID_WORD, s.id);
    return words;
}

// Empty samples have near = 0, and are unpacked like others: divergent branches cost more than they skip.
Sample unpack_sample(Words words) {
    const uint first = ID_WORD - COLOUR_WORDS;
    uvec3 bits = uvec3(0);
    if (COLOUR_WORDS > 0) bits.x = get_word(words, first);
    if (COLOUR_WORDS > 1) bits.y = get_word(words, first + 1);
    if (COLOUR_WORDS > 2) bits.z = get_word(words, first + 2);
    uint id = IDS ? get_word(words, ID_WORD) : NOBODY;
    vec3 colour = uintBitsToFloat(bits);
    if (COMPACT) {
        uvec4 q = words.quads[0];
        float near = abs(uintBitsToFloat(q.x)), depth = uintBitsToFloat(get_word(words, 4));
        if (!TEXTURE) colour = UNBOUNDED_COLOURS ? unpack_shared(bits.x) : unpack_roots(bits.x);
        bool tube = TUBES && (q.z >> 15 & 1) != 0, back = CULL_AUTO && depth < 0.0;
        return Sample(near, near + unpack_length(q.z >> 16), back ? -depth : depth, abs(unpackHalf2x16(q.z).x), unpackHalf2x16(q.y),
                      unpack_direction(q.w), colour, tube, q.x >> 31 != 0, back, colour.xy, id);
    }
    vec4 disc = uintBitsToFloat(words.quads[0]), surface = uintBitsToFloat(words.quads[1]);
    bool tube = TUBES && words.quads[0].y >> 31 != 0;
    bool subpixel = words.quads[0].x >> 31 != 0;
    float depth = uintBitsToFloat(get_word(words, 8));
    bool back = CULL_AUTO && depth < 0.0;
    return Sample(abs(disc.x), surface.w, back ? -depth : depth, abs(disc.y), disc.zw, surface.xyz, colour, tube, subpixel, back, colour.xy, id);
}

// load_NAME: the sample at a texel of the pyramid that is read at descriptor set SET; words_NAME: its words.
#define PYRAMID_TO_READ(SET, NAME)                                                                                 \
    layout(set = SET, binding = 5) uniform utexture2D NAME##_quad0;                                                  \
    layout(set = SET, binding = 6) uniform utexture2D NAME##_quad1;                                                  \
    layout(set = SET, binding = 7) uniform utexture2D NAME##_quad2;                                                  \
    layout(set = SET, binding = 8) uniform utexture2D NAME##_single0;                                                \
    layout(set = SET, binding = 9) uniform utexture2D NAME##_single1;                                                \
    Words words_##NAME(ivec2 at) {                                                                                   \
        Words words = Words(uvec4[3](texelFetch(NAME##_quad0, at, 0), uvec4(0), uvec4(0)), uint[2](0, 0));             \
        if (QUADS > 1) words.quads[1] = texelFetch(NAME##_quad1, at, 0);                                              \
        if (QUADS > 2) words.quads[2] = texelFetch(NAME##_quad2, at, 0);                                              \
        if (SINGLES > 0) words.singles[0] = texelFetch(NAME##_single0, at, 0).r;                                       \
        if (SINGLES > 1) words.singles[1] = texelFetch(NAME##_single1, at, 0).r;                                       \
        return words;                                                                                                \
    }                                                                                                                \
    Sample load_##NAME(ivec2 at) { return unpack_sample(words_##NAME(at)); }

// store_NAME: stores a sample at a texel of the pyramid that is written at descriptor set SET; store_words_NAME: from its words.
#define PYRAMID_TO_WRITE(SET, NAME)                                                                                \
    layout(set = SET, binding = 0, rgba32ui) writeonly uniform uimage2D NAME##_image0;                               \
    layout(set = SET, binding = 1, rgba32ui) writeonly uniform uimage2D NAME##_image1;                               \
    layout(set = SET, binding = 2, rgba32ui) writeonly uniform uimage2D NAME##_image2;                               \
    layout(set = SET, binding = 3, r32ui) writeonly uniform uimage2D NAME##_image3;                                  \
    layout(set = SET, binding = 4, r32ui) writeonly uniform uimage2D NAME##_image4;                                  \
    void store_words_##NAME(ivec2 at, Words words) {                                                                 \
        imageStore(NAME##_image0, at, words.quads[0]);                                                               \
        if (QUADS > 1) imageStore(NAME##_image1, at, words.quads[1]);                                                 \
        if (QUADS > 2) imageStore(NAME##_image2, at, words.quads[2]);                                                 \
        if (SINGLES > 0) imageStore(NAME##_image3, at, uvec4(words.singles[0]));                                       \
        if (SINGLES > 1) imageStore(NAME##_image4, at, uvec4(words.singles[1]));                                       \
    }                                                                                                                \
    void store_##NAME(ivec2 at, Sample s) { store_words_##NAME(at, pack_sample(s)); }

// Centre of a pixel of a level, px.
vec2 level_centre(uint level, ivec2 at) {
    return (vec2(at) + 0.5) * float(1u << level);
}

// Whether a level of this size has this pixel.
bool is_within(ivec2 size, ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, size));
}
