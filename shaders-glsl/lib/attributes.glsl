// Attributes of splats: what the sums of a frame take of each, as rows of four words.

#ifndef LIB_ATTRIBUTES
#define LIB_ATTRIBUTES

layout(constant_id = 45) const bool FRAME_WEIGHTS = false; // some scene has normalization weights, and the frame wants them
layout(constant_id = 46) const bool FRAME_CORNERS = false; // some of these are at the corners of surfels' squares

// Rows that a splat needs; a frame's list may have room for more.
const uint ATTRIBUTE_ROWS = uint(WIDE_SUMS0 || FRAME_WEIGHTS) + uint(WIDE_SUMS1) + 2 * uint(FRAME_CORNERS);

struct Attributes {
    vec3 first;   // normal, or colour
    float weight; // of the kernel, beside its amplitude
    vec3 second;  // colour beside the normal
    vec4 corners; // CORNERS: see weight_in
    vec3 square;  // its first column, and the side that its second one is on
};

#ifdef TILE_PASS
#ifdef SUBGROUPS
layout(set = 1, binding = 18) uniform utextureBuffer attribute_texels;
#define attribute_row(k) uintBitsToFloat(texelFetch(attribute_texels, int(k)))
#else
layout(set = 1, binding = 8, std430) readonly buffer FrameAttributes { vec4 frame_attributes[]; };
#define attribute_row(k) frame_attributes[k]
#endif

Attributes attributes_of(uint id) {
    uint k = hierarchy.attribute_rows * id;
    Attributes own = Attributes(vec3(0.0), 1.0, vec3(0.0), vec4(1.0), vec3(1.0, 0.0, 1.0));
    if (WIDE_SUMS0 || FRAME_WEIGHTS) {
        vec4 row = attribute_row(k);
        own.first = row.xyz;
        own.weight = row.w;
    }
    if (WIDE_SUMS1) own.second = attribute_row(k + 1).xyz;
    if (FRAME_CORNERS) {
        own.corners = attribute_row(k + ATTRIBUTE_ROWS - 2);
        own.square = attribute_row(k + ATTRIBUTE_ROWS - 1).xyz;
    }
    return own;
}
#endif

#endif
