// Workgroups of tile passes: LANES invocations that own a tile and exchange values. They are one subgroup (SUBGROUPS), or use shared memory
// and barriers.
//
// SUBGROUPS: invocations that have diverged at a branch in uniform control flow reconverge after it, so that all of them take part in the next
// shuffle. Vulkan guarantees this to pipelines that require it (VK_KHR_shader_subgroup_uniform_control_flow): `ComputePipeline::new` does where
// the device has the extension. The others are assumed to reconverge at the end of a branch, too. All branches and loops around shuffles are
// uniform in the workgroup.

layout(local_size_x_id = 44) in;

const uint LANES = gl_WorkGroupSize.x;

// Steps of a butterfly over all lanes, a distance of 1 << k each. Loops over k are unrolled; loops that double a distance are not.
const uint STEPS = LANES > 32 ? 6 : LANES > 16 ? 5 : LANES > 8 ? 4 : 3;

#ifdef SUBGROUPS

#define lane gl_SubgroupInvocationID

// Makes writes to shared memory visible to the workgroup.
#define WORKGROUP_BARRIER() subgroupBarrier()

#define DEFINE_SHUFFLE(TYPE, POOL)                                                                                        \
    TYPE shuffle(TYPE value, uint source) { return subgroupShuffle(value, source); }

#else

#define lane gl_LocalInvocationIndex
#define WORKGROUP_BARRIER() barrier()

#define DEFINE_SHUFFLE(TYPE, POOL)                                                                                        \
    shared TYPE POOL[LANES];                                                                                           \
    TYPE shuffle(TYPE value, uint source) {                                                                              \
        barrier();                                                                                                     \
        POOL[lane] = value;                                                                                            \
        barrier();                                                                                                     \
        return POOL[source % LANES];                                                                                           \
    }

#endif

DEFINE_SHUFFLE(float, float_shuffle)
DEFINE_SHUFFLE(vec2, vec2_shuffle)
DEFINE_SHUFFLE(vec3, vec3_shuffle)
DEFINE_SHUFFLE(vec4, vec4_shuffle)
DEFINE_SHUFFLE(uint, uint_shuffle)

// Bit k is set if the condition holds in lane k, or in lane k + 32.
uint workgroup_ballot(bool condition) {
    uint bits = uint(condition) << (lane & 31u);
    for (uint k = 0; k < STEPS; k++) bits |= shuffle(bits, lane ^ 1u << k);
    return bits;
}

float workgroup_min(float value) {
    for (uint k = 0; k < STEPS; k++) value = min(value, shuffle(value, lane ^ 1u << k));
    return value;
}
