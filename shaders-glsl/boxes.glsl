// Boxes: builds the levels of the box hierarchy above the splats; a node bounds eight siblings, which Morton order keeps close together.
// The first dispatch builds the levels up to that of clusters, below those that are not culled; the others build one level each.
#version 450
#pragma variant SUBGROUPS COMPUTE
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#define BOX_ACCESS
#include "lib/box.glsl"
#include "lib/cluster.glsl"
#include "lib/revealed_tiles.glsl"

layout(constant_id = 80) const bool OCCLUSION_CULLING = false; // the boxes of clusters have an upper bound of their κ, from pass cull
#ifdef SUBGROUPS
layout(set = 1, binding = 6, std430) writeonly buffer Boxes { Box boxes[]; };
#endif

layout(local_size_x = 64) in;

// Boxes of this level, padded to a multiple of FAN_OUT, one per invocation. Levels that are written start in the bound range.
layout(push_constant) uniform Level {
    uint finer_start; // first box of the finer level that is read
    uint finer_count; // its boxes
    uint start;       // first box of this level
    uint count;       // its boxes
    uint number;      // of this level, from 0 for splats
    uint loaded;      // level of clusters: its first box in the range that is read
    uint nodes;       // level of clusters: first box of the level below, which is written, too
    uint fronts;      // 1: without splats that face away; 2: as well, if pass hidden has revealed clusters
} level;

// Corners of boxes, and the bits of their nearest κ.
struct Bounds {
    uvec4 corners;
    uint nearest;
};

const Bounds EMPTY = Bounds(uvec4(0xffff, 0xffff, 0, 0), 0);

Bounds join(Bounds a, Bounds b) {
    uvec4 all = uvec4(min(a.corners.xy, b.corners.xy), max(a.corners.zw, b.corners.zw));
    return Bounds(all, max(a.nearest, b.nearest));
}

Box box_of(Bounds bounds) {
    uvec4 at = bounds.corners;
    return Box(at.x | at.y << 16, at.z | at.w << 16, bounds.nearest, NO_CLIP);
}

// Bounds of the siblings from `first` on in the finer level.
Bounds bounds_of_siblings(uint first) {
    Bounds all = EMPTY;
    for (uint k = 0; k < FAN_OUT; k++) {
        uint i = first + k;
        Box box = i < level.finer_count ? load_box(level.finer_start + i) : EMPTY_BOX;
        if (level.fronts != 0 && is_back(box)) box = EMPTY_BOX;
        all = join(all, Bounds(corners(box), box.z));
    }
    return all;
}

void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    if (i >= level.count || OCCLUSION_CULLING && level.fronts == 2 && revealed.listed_count == 0) return;
    if (level.number != CLUSTER_LEVEL) {
        boxes[level.start + i] = box_of(bounds_of_siblings(FAN_OUT * i));
        return;
    }
    // Padding has no cluster.
    bool exists = CLUSTER_SIZE * i < level.finer_count;
    Box cluster = CLUSTERS && exists ? load_box(level.loaded + i) : EMPTY_BOX;
    bool is_culled = cluster.w == CULLED_CLUSTER;
    Bounds all = EMPTY;
    // Blocks have the same order in a tile, and sums the same order of terms, whatever is hidden.
    if (OCCLUSION_CULLING) all.nearest = cluster.z;
    uint end = exists && !is_culled ? FAN_OUT * (i + 1) : 0;
    [[dont_unroll]] for (uint node = FAN_OUT * i; node < end; node++) {
        Bounds bounds = bounds_of_siblings(FAN_OUT * node);
        boxes[level.nodes + node] = box_of(bounds);
        all = join(all, bounds);
    }
    if (!is_culled) boxes[level.start + i] = box_of(all);
}

#endif
