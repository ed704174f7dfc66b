// List of the clusters of a chunk, in all its instances, that were not culled, in any order: after the workgroups of an indirect dispatch of
// one per cluster. Files that run in such dispatches define PER_CLUSTER, and include this one before lib/instance.glsl.

#include "lib/cluster.glsl"

layout(set = 0, binding = 21, std430) VISIBLE_ACCESS buffer VisibleClusters {
    uint columns;
    uint rows;
    uint layers;
    uint visible_count;
    uvec2 visible_clusters[]; // index in the chunk, instance
};

// Clusters per row of the dispatch.
const uint CLUSTER_COLUMNS = 32768;

#ifdef PER_CLUSTER
uint cluster_instance;
#define INSTANCE (CLUSTERS ? cluster_instance : chunk.first_instance + gl_WorkGroupID.z)

// Index of the invocation's surfel, or of its splat in the instance's list; ~0 in workgroups beyond the list. Sets the instance.
uint slot_of_invocation() {
    if (!CLUSTERS) return gl_GlobalInvocationID.x;
    uint index = CLUSTER_COLUMNS * gl_WorkGroupID.y + gl_WorkGroupID.x;
    if (index >= visible_count) return ~0u;
    uvec2 cluster = visible_clusters[index];
    cluster_instance = cluster.y;
    return CLUSTER_SIZE * cluster.x + gl_LocalInvocationID.x;
}
#endif
