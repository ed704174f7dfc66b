// Pyramids of samples: a pixel of a level stores a disc of the surface (marroquim2008 §3). A pixel of level l covers 2^l × 2^l pixels of
// the viewport; screen lengths are viewport pixels on all levels.

#ifndef LEVEL_0_ONLY
layout(constant_id = 17) const bool SUM_COLOURS = false; // samples have colours

// Level to compute, and number of levels. Passes over a scene define LEVEL_0_ONLY and write level 0 only.
layout(push_constant) uniform Step { uint level; uint levels; } pass;
#endif

layout(constant_id = 33) const bool COMPACT = false;           // samples are rounded to 24 bytes
layout(constant_id = 34) const bool UNBOUNDED_COLOURS = false; // some colours may be above 1
layout(constant_id = 38) const bool TEXTURE = false;           // samples have texture coordinates instead of colours
layout(constant_id = 39) const bool IDS = false;               // samples have point ids

#include "lib/compact.glsl"

// Elements per sample in the buffers of depths, of normals, and of colours or coordinates.
const uint DEPTH_PAIRS = COMPACT ? 1 : 2, NORMAL_WORDS = COMPACT ? 1 : 3, COLOUR_WORDS = TEXTURE ? 2 : SUM_COLOURS ? NORMAL_WORDS : 0;

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
    vec2 coordinates;  // of the disc's centre in the texture
    uint id;           // id of the point, or of the nearest of those that were averaged
};

const Sample NO_SAMPLE = Sample(0.0, 0.0, 0.0, 0.0, vec2(0.0), vec3(0.0), vec3(0.0), false, vec2(0.0), NOBODY);

// Normal or tangent, oriented like that of `other`: a tangent has no sign.
vec3 aligned_direction(Sample s, Sample other) {
    return s.tube && dot(s.normal, other.normal) < 0.0 ? -s.normal : s.normal;
}

// Texture coordinates relative to those of `other`, by the shortest way: the texture repeats.
vec2 coordinate_offset(Sample s, Sample other) {
    vec2 offset = s.coordinates - other.coordinates;
    return offset - floor(offset + 0.5);
}

ivec2 level_size(uint level) {
    return (ivec2(frame.viewport) + (1 << level) - 1) >> level;
}

// Index of a level's first sample.
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

// A sample in the bits of a pyramid's buffers; src/frame/pyramids.rs has their formats.
struct PackedSample {
    uvec4 depths;       // near, far, depth, radius; compact: near, depth
    uvec2 displacement; // displacement; compact: as halves, then radius and far − near
    uvec3 normal;       // compact: octahedral
    uvec3 colour;       // if samples have colours; compact: square roots, or with a shared exponent if some may be above 1; or the coordinates
    uint id;            // if samples have ids
};

// The radius of a tube's sample is stored negated.
PackedSample pack_sample(Sample s) {
    float radius = s.tube ? -s.radius : s.radius;
    uvec3 colour = floatBitsToUint(TEXTURE ? vec3(s.coordinates, 0.0) : s.colour);
    if (!COMPACT) {
        vec4 depths = vec4(s.near, s.far, s.depth, radius);
        return PackedSample(floatBitsToUint(depths), floatBitsToUint(s.displacement), floatBitsToUint(s.normal), colour, s.id);
    }
    uvec4 depths = uvec4(floatBitsToUint(s.near), floatBitsToUint(s.depth), 0, 0);
    uint size = pack_halves(vec2(radius, 0.0)) | pack_length(max(s.far - s.near, 0.0)) << 16;
    if (!TEXTURE) colour.x = UNBOUNDED_COLOURS ? pack_shared(s.colour) : pack_roots(s.colour);
    return PackedSample(depths, uvec2(pack_halves(s.displacement), size), uvec3(pack_direction(s.normal), 0, 0), colour, s.id);
}

// Empty samples are zeros, and are unpacked like others: divergent branches cost more than they skip.
Sample unpack_sample(PackedSample p) {
    vec4 depths = uintBitsToFloat(p.depths);
    vec3 colour = uintBitsToFloat(p.colour);
    if (!COMPACT) {
        bool tube = p.depths.w >> 31 != 0;
        return Sample(depths.x, depths.y, depths.z, abs(depths.w), uintBitsToFloat(p.displacement), uintBitsToFloat(p.normal), colour, tube,
                      colour.xy, p.id);
    }
    bool tube = (p.displacement.y >> 15 & 1) != 0;
    float far = depths.x + unpack_length(p.displacement.y >> 16), radius = abs(unpackHalf2x16(p.displacement.y).x);
    if (!TEXTURE) colour = UNBOUNDED_COLOURS ? unpack_shared(p.colour.x) : unpack_roots(p.colour.x);
    return Sample(depths.x, far, depths.y, radius, unpackHalf2x16(p.displacement.x), unpack_direction(p.normal.x), colour, tube, colour.xy, p.id);
}

// Buffers of the pyramid at descriptor set SET: all samples, level by level, fine to coarse. Passes write the pyramid of set 2, `to`, and
// read that of set 3, `from`; shade reads `final` at set 2.
#define PYRAMID(SET, NAME, ACCESS)                                                                         \
    layout(set = SET, binding = 0, std430) ACCESS buffer NAME##Depths { uvec2 NAME##_depths[]; };          \
    layout(set = SET, binding = 1, std430) ACCESS buffer NAME##Displacements { uvec2 NAME##_displacements[]; };          \
    layout(set = SET, binding = 2, std430) ACCESS buffer NAME##Normals { uint NAME##_normals[]; };         \
    layout(set = SET, binding = 3, std430) ACCESS buffer NAME##Colours { uint NAME##_colours[]; };         \
    layout(set = SET, binding = 4, std430) ACCESS buffer NAME##Ids { uint NAME##_ids[]; };

// load_NAME: loads sample i of a pyramid.
#define DEFINE_LOAD(NAME)                                                                                       \
    Sample load_##NAME(uint i) {                                                                           \
        PackedSample p = PackedSample(uvec4(0), NAME##_displacements[i], uvec3(0), uvec3(0), NOBODY);                         \
        p.depths.xy = NAME##_depths[DEPTH_PAIRS * i];                                                           \
        if (DEPTH_PAIRS > 1) p.depths.zw = NAME##_depths[DEPTH_PAIRS * i + 1];                                       \
        for (uint k = 0; k < NORMAL_WORDS; k++) p.normal[k] = NAME##_normals[NORMAL_WORDS * i + k];                      \
        for (uint k = 0; k < COLOUR_WORDS; k++) p.colour[k] = NAME##_colours[COLOUR_WORDS * i + k];        \
        if (IDS) p.id = NAME##_ids[i];                                                                     \
        return unpack_sample(p);                                                                        \
    }

// store_NAME: stores sample i of a pyramid.
#define DEFINE_STORE(NAME)                                                                                       \
    void store_##NAME(uint i, Sample s) {                                                                  \
        PackedSample p = pack_sample(s);                                                                           \
        NAME##_displacements[i] = p.displacement;                                                                        \
        NAME##_depths[DEPTH_PAIRS * i] = p.depths.xy;                                                           \
        if (DEPTH_PAIRS > 1) NAME##_depths[DEPTH_PAIRS * i + 1] = p.depths.zw;                                       \
        for (uint k = 0; k < NORMAL_WORDS; k++) NAME##_normals[NORMAL_WORDS * i + k] = p.normal[k];                      \
        for (uint k = 0; k < COLOUR_WORDS; k++) NAME##_colours[COLOUR_WORDS * i + k] = p.colour[k];        \
        if (IDS) NAME##_ids[i] = p.id;                                                                     \
    }

uint sample_index(uint level, uint start, ivec2 at) {
    return start + uint(at.y * level_size(level).x + at.x);
}

#ifndef LEVEL_0_ONLY

// Declared before its size is used, which is 1 otherwise.
layout(local_size_x = 64) in;

// Pixel of this invocation; below 0 beyond the level.
ivec2 invocation_pixel(uint level) {
    ivec2 size = level_size(level);
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    return i < uint(size.x * size.y) ? ivec2(i % uint(size.x), i / uint(size.x)) : ivec2(-1);
}

#endif
