// Pyramids of samples: what a pixel of a level knows of the surface is a disc (marroquim2008 §3). Level l has a pixel for every 2^l × 2^l of
// the picture's; lengths on the screen are px of the picture, whatever the level.

#ifndef SAMPLES_ONLY
layout(constant_id = 17) const bool SUM_COLOURS = false; // samples have colours

// The level that is made, and how many there are. A pass that has window.glsl defines SAMPLES_ONLY, and touches level 0 alone.
layout(push_constant) uniform Step { uint level; uint levels; } pass;
#endif

struct Sample {
    float near;        // least distance from which on the surface is; 0 where nothing is known
    float far;         // greatest distance up to which another surface is the same
    float depth;       // distance of the disc's centre
    float radius;      // of the disc seen face-on, px
    vec2 displacement; // of the disc's centre from the pixel's, px
    vec3 normal;       // world; of a tube, the tangent
    vec3 colour;       // linear
    bool tube;         // it is of a tube: the disc faces the eye, about a point of the axis
};

layout(set = 1, binding = 1, std430) buffer Pulled { float pulled[]; };
layout(set = 1, binding = 2, std430) buffer Pushed { float pushed[]; };

const Sample NOTHING = Sample(0.0, 0.0, 0.0, 0.0, vec2(0.0), vec3(0.0), vec3(0.0), false);

// Floats of a sample.
uint sample_size() {
    return SUM_COLOURS ? 12u : 9u;
}

// The normal, or the tangent, turned so that it points as that of `other` does: a tangent may as well be its opposite.
vec3 direction_as(Sample s, Sample other) {
    return s.tube && dot(s.normal, other.normal) < 0.0 ? -s.normal : s.normal;
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

// The radius of a tube's sample is stored with a minus. What is not known is stored as zeros, and read like all else: where lanes differ in what
// they know, branches cost more than what they leave out.
#define DEFINE_PYRAMID(LOAD, STORE, FLOATS)                                                            \
    Sample LOAD(uint place) {                                                                          \
        uint i = place * sample_size();                                                                \
        Sample s = NOTHING;                                                                            \
        s.near = FLOATS[i];                                                                            \
        s.far = FLOATS[i + 1];                                                                         \
        s.depth = FLOATS[i + 2];                                                                       \
        s.tube = floatBitsToUint(FLOATS[i + 3]) >> 31 != 0;                                            \
        s.radius = abs(FLOATS[i + 3]);                                                                 \
        s.displacement = vec2(FLOATS[i + 4], FLOATS[i + 5]);                                           \
        s.normal = vec3(FLOATS[i + 6], FLOATS[i + 7], FLOATS[i + 8]);                                  \
        if (SUM_COLOURS) s.colour = vec3(FLOATS[i + 9], FLOATS[i + 10], FLOATS[i + 11]);               \
        return s;                                                                                      \
    }                                                                                                  \
    void STORE(uint place, Sample s) {                                                                 \
        uint i = place * sample_size();                                                                \
        FLOATS[i] = s.near;                                                                            \
        FLOATS[i + 1] = s.far;                                                                         \
        FLOATS[i + 2] = s.depth;                                                                       \
        FLOATS[i + 3] = s.tube ? -s.radius : s.radius;                                                 \
        FLOATS[i + 4] = s.displacement.x;                                                              \
        FLOATS[i + 5] = s.displacement.y;                                                              \
        for (uint k = 0; k < 3; k++) FLOATS[i + 6 + k] = s.normal[k];                                  \
        if (SUM_COLOURS) for (uint k = 0; k < 3; k++) FLOATS[i + 9 + k] = s.colour[k];                 \
    }

DEFINE_PYRAMID(load_pulled, store_pulled, pulled)
DEFINE_PYRAMID(load_pushed, store_pushed, pushed)

// The pixel of this invocation; below 0 beyond the level.
ivec2 own_pixel(uint level) {
    ivec2 size = level_size(level);
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    return i < uint(size.x * size.y) ? ivec2(i % uint(size.x), i / uint(size.x)) : ivec2(-1);
}

uint place_in(uint level, uint start, ivec2 at) {
    return start + uint(at.y * level_size(level).x + at.x);
}
