// Attributes of splats on the tile path: the values that sums read, as rows of four words.

#ifndef LIB_ATTRIBUTES
#define LIB_ATTRIBUTES

#include "lib/normal_field.glsl"

layout(constant_id = 45) const bool FRAME_WEIGHTS = false; // some scene has normalization weights, and the frame uses them
layout(constant_id = 46) const bool FRAME_CORNERS = false; // some of these are at the corners of squares

// Rows of a splat in this frame; the stride in the list may be larger.
const uint FIELD_ROW = uint(WIDE_SUMS0 || FRAME_WEIGHTS) + uint(WIDE_SUMS1);
const uint ATTRIBUTE_ROWS = FIELD_ROW + uint(FRAME_NORMAL_FIELDS) + 2 * uint(FRAME_CORNERS);

struct Attributes {
    vec3 attribute0; // normal or colour: see lib/sums.glsl
    float weight;    // weight of the kernel without its amplitude
    vec3 attribute1; // colour, if attribute0 is a normal
    mat2x3 field;    // of normals, per σ along the kernel's axes
    vec4 corners;    // CORNERS: see bilinear_weight
    vec3 square;     // first column, and the sign of the second
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
    Attributes attributes = Attributes(vec3(0.0), 1.0, vec3(0.0), mat2x3(0.0), vec4(1.0), vec3(1.0, 0.0, 1.0));
    if (WIDE_SUMS0 || FRAME_WEIGHTS) {
        vec4 row = attribute_row(k);
        attributes.attribute0 = row.xyz;
        attributes.weight = row.w;
    }
    if (WIDE_SUMS1) attributes.attribute1 = attribute_row(k + 1).xyz;
    if (FRAME_NORMAL_FIELDS) attributes.field = field_of(attributes.attribute0, attribute_row(k + FIELD_ROW));
    if (FRAME_CORNERS) {
        attributes.corners = attribute_row(k + ATTRIBUTE_ROWS - 2);
        attributes.square = attribute_row(k + ATTRIBUTE_ROWS - 1).xyz;
    }
    return attributes;
}
#endif

#endif
