// The nearest splat of each pixel: its κ, whose bits order like it, above the complement of its index, so that the lowest wins a tie.

layout(set = 1, binding = 0, std430) WINNER_ACCESS buffer Winners { uint64_t winners[]; };

uint pixel_index(ivec2 pixel) {
    return uint(pixel.y) * uint(frame.viewport.x) + uint(pixel.x);
}

// Never 0: that means nothing is there.
uint64_t winner(float key, uint i) {
    return uint64_t(floatBitsToUint(key)) << 32 | uint64_t(~(first_number() + i));
}
