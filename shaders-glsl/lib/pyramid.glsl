// Pyramids of samples: what a pixel of a level knows of the surface is a disc (marroquim2008 §3). Level l has a pixel for every 2^l × 2^l of
// the picture's; lengths on the screen are px of the picture, whatever the level.

#ifndef SAMPLES_ONLY
layout(constant_id = 17) const bool SUM_COLOURS = false; // samples have colours

// The level that is made, and how many there are. A pass over a scene defines SAMPLES_ONLY, and touches level 0 alone.
layout(push_constant) uniform Step { uint level; uint levels; } pass;
#endif

layout(constant_id = 33) const bool COMPACT = false;           // samples are rounded to 24 bytes
layout(constant_id = 34) const bool UNBOUNDED_COLOURS = false; // some colours may be beyond 1
layout(constant_id = 38) const bool TEXTURE = false;           // samples have coordinates in a texture instead
layout(constant_id = 39) const bool IDS = false;               // samples have numbers

#include "lib/compact.glsl"

// Elements of a sample in the planes of depths, of normals, and of colours or coordinates.
const uint DEPTHS = COMPACT ? 1 : 2, WORDS = COMPACT ? 1 : 3, COLOUR_WORDS = TEXTURE ? 2 : SUM_COLOURS ? WORDS : 0;

// The number of nothing.
const uint NOBODY = 0xffffffffu;

struct Sample {
    float near;        // least distance from which on the surface is; 0 where nothing is known
    float far;         // greatest distance up to which another surface is the same
    float depth;       // distance of the disc's centre
    float radius;      // of the disc seen face-on, px
    vec2 displacement; // of the disc's centre from the pixel's, px
    vec3 normal;       // world; of a tube, the tangent
    vec3 colour;       // linear
    bool tube;         // it is of a tube: the disc faces the eye, about a point of the axis
    vec2 coordinates;  // of the disc's centre in the texture
    uint id;           // number of the point that it is, or that is nearest of those that it was made of
};

const Sample NOTHING = Sample(0.0, 0.0, 0.0, 0.0, vec2(0.0), vec3(0.0), vec3(0.0), false, vec2(0.0), NOBODY);

// The normal, or the tangent, turned so that it points as that of `other` does: a tangent may as well be its opposite.
vec3 direction_as(Sample s, Sample other) {
    return s.tube && dot(s.normal, other.normal) < 0.0 ? -s.normal : s.normal;
}

// The way to its coordinates in the texture from those of `other`: as the texture is repeated, the shortest.
vec2 turn_from(Sample s, Sample other) {
    vec2 way = s.coordinates - other.coordinates;
    return way - floor(way + 0.5);
}

ivec2 level_size(uint level) {
    return (ivec2(frame.viewport) + (1 << level) - 1) >> level;
}

// Where the samples of a level start.
uint level_start(uint level) {
    uint start = 0;
    for (uint l = 0; l < level; l++) {
        ivec2 size = level_size(l);
        start += uint(size.x * size.y);
    }
    return start;
}

// Centre of a pixel of a level, px.
vec2 level_centre(uint level, ivec2 at) {
    return (vec2(at) + 0.5) * float(1u << level);
}

bool is_within(uint level, ivec2 at) {
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, level_size(level)));
}

// A sample as the planes of a pyramid hold it, in bits; src/frame/pyramids.rs has their sizes.
struct Planes {
    uvec4 depths; // near, far, depth, radius; compact: near, depth
    uvec2 place;  // displacement; compact: halves of it and the radius, and what far is beyond near
    uvec3 normal; // compact: octahedral
    uvec3 colour; // where samples have one; compact: square roots, or with a shared exponent where it may be beyond 1; or the coordinates
    uint id;      // where samples have one
};

// The radius of a tube's sample has a minus.
Planes planes_of(Sample s) {
    float radius = s.tube ? -s.radius : s.radius;
    uvec3 colour = floatBitsToUint(TEXTURE ? vec3(s.coordinates, 0.0) : s.colour);
    if (!COMPACT) {
        vec4 depths = vec4(s.near, s.far, s.depth, radius);
        return Planes(floatBitsToUint(depths), floatBitsToUint(s.displacement), floatBitsToUint(s.normal), colour, s.id);
    }
    uvec4 depths = uvec4(floatBitsToUint(s.near), floatBitsToUint(s.depth), 0, 0);
    uint size = pack_halves(vec2(radius, 0.0)) | pack_length(max(s.far - s.near, 0.0)) << 16;
    if (!TEXTURE) colour.x = UNBOUNDED_COLOURS ? pack_shared(s.colour) : pack_roots(s.colour);
    return Planes(depths, uvec2(pack_halves(s.displacement), size), uvec3(pack_direction(s.normal), 0, 0), colour, s.id);
}

// What is not known is stored as zeros, and read like all else: where lanes differ in what they know, branches cost more than what they leave
// out.
Sample sample_of_planes(Planes p) {
    vec4 depths = uintBitsToFloat(p.depths);
    vec3 colour = uintBitsToFloat(p.colour);
    if (!COMPACT) {
        bool tube = p.depths.w >> 31 != 0;
        return Sample(depths.x, depths.y, depths.z, abs(depths.w), uintBitsToFloat(p.place), uintBitsToFloat(p.normal), colour, tube,
                      colour.xy, p.id);
    }
    bool tube = (p.place.y >> 15 & 1) != 0;
    float far = depths.x + unpack_length(p.place.y >> 16), radius = abs(unpackHalf2x16(p.place.y).x);
    if (!TEXTURE) colour = UNBOUNDED_COLOURS ? unpack_shared(p.colour.x) : unpack_roots(p.colour.x);
    return Sample(depths.x, far, depths.y, radius, unpackHalf2x16(p.place.x), unpack_direction(p.normal.x), colour, tube, colour.xy, p.id);
}

// The planes of the pyramid at descriptor set SET: all samples, level after level, fine to coarse. Passes write the one of set 2, `to`, and
// read that of set 3, `from`; shade reads that of set 2, `final`.
#define PYRAMID(SET, NAME, ACCESS)                                                                         \
    layout(set = SET, binding = 0, std430) ACCESS buffer NAME##Depths { uvec2 NAME##_depths[]; };          \
    layout(set = SET, binding = 1, std430) ACCESS buffer NAME##Places { uvec2 NAME##_places[]; };          \
    layout(set = SET, binding = 2, std430) ACCESS buffer NAME##Normals { uint NAME##_normals[]; };         \
    layout(set = SET, binding = 3, std430) ACCESS buffer NAME##Colours { uint NAME##_colours[]; };         \
    layout(set = SET, binding = 4, std430) ACCESS buffer NAME##Ids { uint NAME##_ids[]; };

// load_NAME: sample i of a pyramid.
#define LOADED(NAME)                                                                                       \
    Sample load_##NAME(uint i) {                                                                           \
        Planes p = Planes(uvec4(0), NAME##_places[i], uvec3(0), uvec3(0), NOBODY);                         \
        p.depths.xy = NAME##_depths[DEPTHS * i];                                                           \
        if (DEPTHS > 1) p.depths.zw = NAME##_depths[DEPTHS * i + 1];                                       \
        for (uint k = 0; k < WORDS; k++) p.normal[k] = NAME##_normals[WORDS * i + k];                      \
        for (uint k = 0; k < COLOUR_WORDS; k++) p.colour[k] = NAME##_colours[COLOUR_WORDS * i + k];        \
        if (IDS) p.id = NAME##_ids[i];                                                                     \
        return sample_of_planes(p);                                                                        \
    }

// store_NAME: the same, written.
#define STORED(NAME)                                                                                       \
    void store_##NAME(uint i, Sample s) {                                                                  \
        Planes p = planes_of(s);                                                                           \
        NAME##_places[i] = p.place;                                                                        \
        NAME##_depths[DEPTHS * i] = p.depths.xy;                                                           \
        if (DEPTHS > 1) NAME##_depths[DEPTHS * i + 1] = p.depths.zw;                                       \
        for (uint k = 0; k < WORDS; k++) NAME##_normals[WORDS * i + k] = p.normal[k];                      \
        for (uint k = 0; k < COLOUR_WORDS; k++) NAME##_colours[COLOUR_WORDS * i + k] = p.colour[k];        \
        if (IDS) NAME##_ids[i] = p.id;                                                                     \
    }

uint place_in(uint level, uint start, ivec2 at) {
    return start + uint(at.y * level_size(level).x + at.x);
}

#ifndef SAMPLES_ONLY

// Before its size is used, which were 1 otherwise.
layout(local_size_x = 64) in;

// The pixel of this invocation; below 0 beyond the level.
ivec2 own_pixel(uint level) {
    ivec2 size = level_size(level);
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    return i < uint(size.x * size.y) ? ivec2(i % uint(size.x), i / uint(size.x)) : ivec2(-1);
}

#endif
