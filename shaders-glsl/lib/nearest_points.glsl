// Nearest point of each pixel: the bits of its distance, which order like it, above its id, so that the lowest id wins a tie. All bits are
// set in empty pixels.

layout(set = 1, binding = 6, std430) NEAREST_ACCESS buffer Nearest { uint64_t nearest_points[]; };

const uint64_t NO_POINT = ~uint64_t(0);

uint64_t nearest_point(uint id, float distance) {
    return uint64_t(floatBitsToUint(distance)) << 32 | uint64_t(id);
}
