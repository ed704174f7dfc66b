// The nearest point of each pixel: the bits of its distance, which order like it, above its number, so that the lowest wins a tie. All bits
// are set where there is none.

layout(set = 1, binding = 6, std430) NEAREST_ACCESS buffer Nearest { uint64_t nearest_points[]; };

const uint64_t NO_POINT = ~uint64_t(0);

uint64_t nearest_point(uint number, float distance) {
    return uint64_t(floatBitsToUint(distance)) << 32 | uint64_t(number);
}
