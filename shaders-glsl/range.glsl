// Range: least and greatest value of a scalar image, over the pixels that show a surface.
#version 450
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform ScalarOptions {
    float least_alpha; // pixels with less α show no surface
    uint opaque;       // whether covered pixels become opaque
} options;

layout(set = 0, binding = 0) uniform texture2D screen; // value times α, α
layout(set = 0, binding = 1, std430) buffer ValueRange {
    uint least;    // ordered_bits of the least value
    uint greatest; // complement of the ordered_bits of the greatest value: both start as all ones and fall
} range;

// Side of the block of pixels that an invocation reads.
const int SIDE = 8;

// Bits in the order of the floats.
uint ordered_bits(float value) {
    uint bits = floatBitsToUint(value);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

void main() {
    ivec2 size = textureSize(screen, 0);
    ivec2 low = SIDE * ivec2(gl_GlobalInvocationID.xy);
    ivec2 high = min(low + SIDE, size);
    uint least = 0xffffffffu, greatest = 0xffffffffu;
    for (int y = low.y; y < high.y; y++) {
        for (int x = low.x; x < high.x; x++) {
            vec4 texel = texelFetch(screen, ivec2(x, y), 0);
            if (texel.a < options.least_alpha) continue;
            uint bits = ordered_bits(texel.r / texel.a);
            least = min(least, bits);
            greatest = min(greatest, ~bits);
        }
    }
    atomicMin(range.least, least);
    atomicMin(range.greatest, greatest);
}

#endif
