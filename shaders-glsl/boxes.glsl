// Boxes: builds a level of the box hierarchy above the splats; a node bounds eight siblings, which Morton order keeps close together.
#version 450
#pragma variant SUBGROUPS COMPUTE
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#define BOX_ACCESS
#include "lib/box.glsl"
#include "lib/cluster.glsl"
#ifdef SUBGROUPS
layout(set = 1, binding = 6, std430) writeonly buffer Boxes { Box boxes[]; };
#endif

layout(local_size_x = 64) in;

layout(push_constant) uniform Level {
    uint finer_start; // first box of the finer level
    uint start;       // first box of this level in the bound range
    uint count;       // boxes of this level, padded to a multiple of FAN_OUT
    uint finer_count; // boxes of the finer level
    uint number;      // of this level, from 0 for splats
    uint clusters;    // first box of the level of clusters
    uint fronts;      // 1: without splats that face away
} level;

// Whether the node is that of a culled cluster or below one. Padding has no cluster.
bool is_culled(uint i) {
    if (!CLUSTERS || level.number > CLUSTER_LEVEL || FAN_OUT * i >= level.finer_count) return false;
    uint cluster = i >> (level.number == CLUSTER_LEVEL ? 0 : 3);
    return load_box(level.clusters + cluster).w == CULLED_CLUSTER;
}

void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= level.count || is_culled(i)) return;
    uvec4 bounds = uvec4(0xffff, 0xffff, 0, 0);
    uint nearest = 0;
    for (uint k = 0; k < FAN_OUT; k++) {
        uint child = FAN_OUT * i + k;
        Box box = child < level.finer_count ? load_box(level.finer_start + child) : EMPTY_BOX;
        if (level.fronts != 0 && is_back(box)) box = EMPTY_BOX;
        uvec4 own = corners(box);
        bounds.xy = min(bounds.xy, own.xy);
        bounds.zw = max(bounds.zw, own.zw);
        nearest = max(nearest, box.z);
    }
    boxes[level.start + i] = Box(bounds.x | bounds.y << 16, bounds.z | bounds.w << 16, nearest, NO_CLIP);
}

#endif
