// Clusters of consecutive surfels: nodes of a fixed level of the box hierarchy, whose splats have no boxes if the cluster is culled.

#ifndef LIB_CLUSTER
#define LIB_CLUSTER

// Surfels of a cluster.
const uint CLUSTER_SIZE = 64;
// Level of the box hierarchy whose nodes bound a cluster's splats.
const uint CLUSTER_LEVEL = 2;

layout(constant_id = 63) const bool CLUSTERS = false; // the frame culls clusters

// Last word of the box of a culled cluster, whose children are undefined. Other nodes have NO_CLIP.
const uint CULLED_CLUSTER = 0;

#endif
