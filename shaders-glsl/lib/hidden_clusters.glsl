// Two-phase occlusion culling of clusters: those that were hidden in the last frame are drawn only where the others do not hide them in this
// one, either. The including file defines HIDDEN_ACCESS.

#include "lib/shown_key.glsl"

layout(constant_id = 80) const bool OCCLUSION_CULLING = false;

// By instance in the descriptor set and cluster of the chunk, whether it was hidden.
layout(set = 0, binding = 24, std430) HIDDEN_ACCESS buffer HiddenClusters { uint hidden_clusters[]; };

uint hidden_index(uint instance, uint cluster) {
    return instance * (chunk.instance_stride / CLUSTER_SIZE) + cluster;
}

// How far the fragments of a cluster's splats extend beyond its discs' centres, in units of length: the projected disc, or what the kinds of
// footprints make of it, with a margin for its distance, which varies over the disc. Splats are wider by splat_margin px.
float splat_reach(Cluster cluster) {
    return 1.25 * largest_stretch() * cluster.low.w;
}

// Least distance in reaches at which they bound a cluster.
const float NEAREST_REACHES = 4.0;

// A κ that no surface hides, and one that no cluster is bounded by.
const float NEVER_HIDDEN = 3.0, LEAST_BOUND = 1e-30;

// Upper bound of the κ of fragments of the cluster's splats, NEVER_HIDDEN where none is known.
float nearest_key_of(Cluster cluster) {
    CentreBox box = centres_of(cluster);
    float reach = splat_reach(cluster);
    float distance = bounds_on(PERSPECTIVE ? view.rows_hi[2].xyz : view.forward_hi.xyz, 0.0, box.low, box.high).x;
    if (PERSPECTIVE && !(distance > NEAREST_REACHES * reach)) return NEVER_HIDDEN;
    return max(1.00001 * largest_shown_key(key_at_distance(distance - reach)), LEAST_BOUND);
}
