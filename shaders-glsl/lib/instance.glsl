// Instances of a scene. Passes run in the axes and unit of the scene; κ and pixels are those of the world, and directions and distances
// shared between instances are transformed. A dispatch covers several instances, one per workgroup along z. A draw covers several, whose
// vertices follow each other: Vulkan instances of few vertices would be slower.

#define PER_INSTANCE
#include "lib/frame.glsl"

layout(constant_id = 37) const bool INSTANCED = false; // scenes are instanced: each instance has its own ids

#ifndef FRAGMENT
// Push constants of a command over a chunk of surfels, lines or triangles, and its ranges in per-instance buffers.
layout(push_constant) uniform Chunk {
    uint count;           // elements: surfels, lines or triangles
    uint first_id;        // id of the first element in the scene
    uint capacity;        // surfels that the chunk has room for
    uint instance_stride; // stride of an instance in buffers of one value per element
    uint clip_stride;     // stride of an instance in the buffer of screen clips
    uint first_instance;  // first instance, of those in the descriptor set
    uint first_clip;      // index in the frame of the first screen clip in the descriptor set
    uint attribute_rows;  // attribute rows per splat in the frame's list
    uint instance_count;  // instances in this frame, of those in the descriptor set
    uint first_node;      // node of the first cluster of the range in the bound levels of the frame's box hierarchy
    uint group_count;     // groups of clusters, of all instances
    uint revealed;        // 1: only clusters that pass hidden has revealed
} chunk;

#ifdef VERTEX
// Surfel of a vertex.
uint surfel_index() {
    uint i = gl_VertexIndex / VERTICES;
    return INSTANCED ? i % chunk.count : i;
}
#endif

// Instance of an invocation, unless the including file defines another.
#ifndef INSTANCE
#define INSTANCE (chunk.first_instance + gl_WorkGroupID.z)
#endif

// Index of the instance in the descriptor set.
uint instance_index() {
#ifdef VERTEX
    return INSTANCED ? chunk.first_instance + gl_VertexIndex / VERTICES / chunk.count : 0;
#else
    return INSTANCED ? INSTANCE : 0;
#endif
}

#ifdef PER_CLUSTER
#include "lib/cluster_entry.glsl"
#endif

// Words of the header of a buffer of per-instance lists: the length of each list.
const uint LIST_HEADER = 64;

// Start of the instance's list in such a buffer.
uint list_start() {
    return LIST_HEADER + instance_index() * chunk.instance_stride;
}

// Id in the frame of the chunk's first point.
uint first_id() {
    return chunk.first_id + (INSTANCED ? view.first_id : 0);
}

// Transforms a direction from scene to world space.
vec3 to_world(vec3 direction) {
    if (!INSTANCED) return direction;
    return view.rotation[0].xyz * direction.x + view.rotation[1].xyz * direction.y + view.rotation[2].xyz * direction.z;
}

// Converts a distance from the eye to the world's unit; rounding does not move it in front of the near plane.
float world_distance(float distance) {
    return INSTANCED ? max(view.scale * distance, frame.near) : distance;
}

#endif
