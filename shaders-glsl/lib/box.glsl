// Boxes: the pixels that a splat, or the splats of a node of the hierarchy above them, can have fragments at, and how near.

#ifndef LIB_BOX
#define LIB_BOX

// low | high: x in the lower 16 bits, y in the upper; the bits of the nearest κ; of a splat the number of its clip on the screen, or NO_CLIP.
#define Box uvec4

const uint NO_CLIP = ~0u;

// Holds no pixel.
const Box EMPTY_BOX = Box(0xffffffffu, 0u, 0u, NO_CLIP);

#if defined(BOX_ACCESS) && defined(SUBGROUPS)
layout(set = 1, binding = 16) uniform utextureBuffer box_texels;
Box load_box(uint i) {
    return texelFetch(box_texels, int(i));
}
#elif defined(BOX_ACCESS)
layout(set = 1, binding = 6, std430) BOX_ACCESS buffer Boxes { Box boxes[]; };
Box load_box(uint i) {
    return boxes[i];
}
#endif

// Children of a node.
const uint FAN_OUT = 8;

Box box_of(ivec2 low, ivec2 high, float nearest, uint clip) {
    uvec2 l = uvec2(low), h = uvec2(high);
    return Box(l.x | l.y << 16, h.x | h.y << 16, floatBitsToUint(max(nearest, 0.0)), clip);
}

// Whether it has pixels of those from `low` to `high`.
bool meets(Box box, uvec2 low, uvec2 high) {
    uvec4 sides = uvec4(box.x & 0xffffu, box.x >> 16, box.y & 0xffffu, box.y >> 16);
    return all(lessThanEqual(sides.xy, high)) && all(greaterThanEqual(sides.zw, low));
}

float nearest_in(Box box) {
    return uintBitsToFloat(box.z);
}

#endif
