// A team: the LANES invocations of a workgroup, which own a tile together and pass values on. They are one subgroup (SUBGROUPS), or use
// shared memory and barriers.

layout(local_size_x_id = 44) in;

const uint LANES = gl_WorkGroupSize.x;

// Steps by powers of two over all lanes, 1 << k of each k. Loops over k are unrolled, those that double a step are not.
const uint STEPS = LANES > 32 ? 6 : LANES > 16 ? 5 : LANES > 8 ? 4 : 3;

#ifdef SUBGROUPS

#define lane gl_SubgroupInvocationID

// Makes what the team has written to shared memory visible to it.
#define TEAM_BARRIER() subgroupBarrier()

#define DEFINE_TEAM(TYPE, POOL)                                                                                        \
    TYPE of_lane(TYPE value, uint from) { return subgroupShuffle(value, from); }

#else

#define lane gl_LocalInvocationIndex
#define TEAM_BARRIER() barrier()

#define DEFINE_TEAM(TYPE, POOL)                                                                                        \
    shared TYPE POOL[LANES];                                                                                           \
    TYPE of_lane(TYPE value, uint from) {                                                                              \
        barrier();                                                                                                     \
        POOL[lane] = value;                                                                                            \
        barrier();                                                                                                     \
        return POOL[from % LANES];                                                                                             \
    }

#endif

DEFINE_TEAM(float, float_of_lane)
DEFINE_TEAM(vec2, vec2_of_lane)
DEFINE_TEAM(vec3, vec3_of_lane)
DEFINE_TEAM(vec4, vec4_of_lane)
DEFINE_TEAM(uint, uint_of_lane)

// Bit k is whether `yes` holds for lane k.
uint team_ballot(bool yes) {
    uint bits = uint(yes) << lane;
    for (uint k = 0; k < STEPS; k++) bits |= of_lane(bits, lane ^ 1u << k);
    return bits;
}

float team_min(float value) {
    for (uint k = 0; k < STEPS; k++) value = min(value, of_lane(value, lane ^ 1u << k));
    return value;
}

float team_max(float value) {
    for (uint k = 0; k < STEPS; k++) value = max(value, of_lane(value, lane ^ 1u << k));
    return value;
}
