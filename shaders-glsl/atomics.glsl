// Atomics: an atomic minimum per invocation, of a pseudo-random word of a buffer. WIDE words have 64 bits (src/bench/ceilings.rs).
#version 450
#pragma variant WIDE
#ifdef COMPUTE
#ifdef WIDE
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#endif

layout(local_size_x = 64) in;

layout(push_constant) uniform AtomicOptions {
    uint mask; // number of words, a power of two, less 1
    uint seed; // of the words and their values
} options;

#ifdef WIDE
layout(set = 0, binding = 0, std430) buffer WideWords { uint64_t wide_words[]; };
#else
layout(set = 0, binding = 0, std430) buffer Words { uint words[]; };
#endif

// A bijection of 32-bit words: the output function of PCG (Jarzynski, Olano, Hash Functions for GPU Rendering, JCGT 2020).
uint hash(uint value) {
    uint state = value * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

void main() {
    uint invocation = gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x + gl_GlobalInvocationID.x;
    uint value = hash(invocation + options.seed);
    uint index = hash(value) & options.mask;
#ifdef WIDE
    atomicMin(wide_words[index], uint64_t(value) << 32 | uint64_t(invocation));
#else
    atomicMin(words[index], value);
#endif
}

#endif
