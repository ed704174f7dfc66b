// Boxes: the next level of the hierarchy above the splats: the union of the boxes of eight neighbours, which Morton order keeps close.
#version 450
#pragma variant SUBGROUPS COMPUTE
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#define BOX_ACCESS
#include "lib/box.glsl"
#ifdef SUBGROUPS
layout(set = 1, binding = 6, std430) writeonly buffer Boxes { Box boxes[]; };
#endif

layout(local_size_x = 64) in;

layout(push_constant) uniform Level {
    uint from;  // first box of the finer level
    uint to;    // first box of this level, in what is bound to be written
    uint nodes; // boxes of this level, with those that fill it up to a multiple of FAN_OUT
    uint finer; // boxes of the finer level
} level;

void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= level.nodes) return;
    Box all_of = EMPTY_BOX;
    uvec4 sides = uvec4(0xffff, 0xffff, 0, 0);
    uint nearest = 0;
    for (uint k = 0; k < FAN_OUT; k++) {
        uint child = FAN_OUT * i + k;
        Box box = child < level.finer ? load_box(level.from + child) : EMPTY_BOX;
        sides.xy = min(sides.xy, uvec2(box.x & 0xffffu, box.x >> 16));
        sides.zw = max(sides.zw, uvec2(box.y & 0xffffu, box.y >> 16));
        nearest = max(nearest, box.z);
    }
    boxes[level.to + i] = Box(sides.x | sides.y << 16, sides.z | sides.w << 16, nearest, NO_CLIP);
}

#endif
