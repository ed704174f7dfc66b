// Per-pixel buffers of the compute path, row by row from the top left; read-only unless the including pass defines another access.

#ifndef VISIBILITY_ACCESS
#define VISIBILITY_ACCESS readonly
#endif
#ifndef SUMS_ACCESS
#define SUMS_ACCESS readonly
#endif

// Bits of κ: for κ ≥ 0 they order like κ. Before sides, FULL_PIXEL marks pixels that lie within the solid part of a disc.
layout(set = 1, binding = 0, std430) VISIBILITY_ACCESS buffer Visibility { uint visibility[]; };
const uint FULL_PIXEL = 0x80000000u;
layout(set = 1, binding = 1, std430) SUMS_ACCESS buffer Sums0 { float sums0[]; };
layout(set = 1, binding = 2, std430) SUMS_ACCESS buffer Sums1 { float sums1[]; };

uint pixel_index(ivec2 pixel) {
    return uint(pixel.y) * uint(frame.viewport.x) + uint(pixel.x);
}
