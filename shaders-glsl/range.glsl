// Range: the least and the greatest of a picture's numbers, of the pixels that show a surface.
#version 450
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Numbers {
    float least_alpha; // a pixel that is less covered shows no surface
    uint opaque;       // whether one that is covered shows nothing else
} numbers;

layout(set = 0, binding = 0) uniform texture2D screen; // red times α, α
layout(set = 0, binding = 1, std430) buffer NumberRange {
    uint least;    // bits_of the least number
    uint greatest; // the complement of those of the greatest: both fall from all ones
} range;

// Side of the block of pixels that an invocation visits.
const int SIDE = 8;

// Bits that are in the order of the numbers.
uint bits_of(float number) {
    uint bits = floatBitsToUint(number);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

void main() {
    ivec2 size = textureSize(screen, 0);
    ivec2 low = SIDE * ivec2(gl_GlobalInvocationID.xy);
    ivec2 high = min(low + SIDE, size);
    uint least = 0xffffffffu, greatest = 0xffffffffu;
    for (int y = low.y; y < high.y; y++) {
        for (int x = low.x; x < high.x; x++) {
            vec4 seen = texelFetch(screen, ivec2(x, y), 0);
            if (seen.a < numbers.least_alpha) continue;
            uint bits = bits_of(seen.r / seen.a);
            least = min(least, bits);
            greatest = min(greatest, ~bits);
        }
    }
    atomicMin(range.least, least);
    atomicMin(range.greatest, greatest);
}

#endif
