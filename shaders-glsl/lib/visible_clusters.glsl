// List of the clusters of a chunk, in all its instances, that were not culled, in any order: after the workgroups of an indirect dispatch of
// one per cluster. Files that run in such dispatches define PER_CLUSTER, and include this one before lib/instance.glsl.

#include "lib/cluster.glsl"

struct VisibleCluster {
    uint cluster;  // index in the chunk
    uint slot;     // index in the chunk's range of the frame's splat list
    uint instance; // in the descriptor set
};

layout(set = 0, binding = 21, std430) VISIBLE_ACCESS buffer VisibleClusters {
    uint columns;
    uint rows;
    uint layers;
    uint visible_count;
    // The same for clusters that were hidden in the last frame, and are not in this one (pass hidden): they follow the others.
    uint revealed_columns;
    uint revealed_rows;
    uint revealed_layers;
    uint revealed_count;
    VisibleCluster visible_clusters[];
};

// Clusters per row of the dispatch.
const uint CLUSTER_COLUMNS = 32768;

#ifdef PER_CLUSTER
VisibleCluster visible;
#define INSTANCE (CLUSTERS ? visible.instance : chunk.first_instance + gl_WorkGroupID.z)
#endif
