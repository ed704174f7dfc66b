// Boxes: bounding boxes, in pixels and depth, of the fragments of a splat or of the splats below a node of the hierarchy.

#ifndef LIB_BOX
#define LIB_BOX

// Two corners, x in the lower 16 bits, y in the upper 15, and BACK_BOX in the second; bits of the nearest κ; of a splat, the index of its
// screen clip or NO_CLIP.
#define Box uvec4

const uint NO_CLIP = ~0u;

// Of a splat that faces away and has yet to pass sides.glsl.
const uint BACK_BOX = 0x80000000u;

// Contains no pixel.
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

bool is_back(Box box) {
    return (box.y & BACK_BOX) != 0;
}

bool is_empty(Box box) {
    return box.x == EMPTY_BOX.x;
}

// The corners: low x and y, high x and y.
uvec4 corners(Box box) {
    return uvec4(box.x & 0xffffu, box.x >> 16, box.y & 0xffffu, (box.y & ~BACK_BOX) >> 16);
}

// Whether the box overlaps the pixels from `low` to `high`, inclusive.
bool overlaps(Box box, uvec2 low, uvec2 high) {
    uvec4 bounds = corners(box);
    return all(lessThanEqual(bounds.xy, high)) && all(greaterThanEqual(bounds.zw, low));
}

float nearest_key(Box box) {
    return uintBitsToFloat(box.z);
}

#endif
