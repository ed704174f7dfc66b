// Entries of invocations in dispatches over visible clusters: see lib/visible_clusters.glsl.

// Entry of the invocation in the order of the chunk's surfels, which is that of storage unless lib/order.glsl has another; ~0 in workgroups
// beyond the list. Sets the visible cluster.
uint entry_of_invocation() {
    if (!CLUSTERS) return gl_GlobalInvocationID.x;
    uint index = CLUSTER_COLUMNS * gl_WorkGroupID.y + gl_WorkGroupID.x;
    bool is_revealed = chunk.revealed != 0;
    if (index >= (is_revealed ? revealed_count : visible_count)) return ~0u;
    visible = visible_clusters[is_revealed ? visible_count + index : index];
    return CLUSTER_SIZE * visible.cluster + gl_LocalInvocationID.x;
}
