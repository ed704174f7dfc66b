// Cull reasons of surfels, and their counters in this order; DRAWN if not culled.

const uint BEHIND = 0;    // the centre is not in front of the eye; of a point, not between the near and the far plane
const uint EYE_PLANE = 1; // the disc reaches the eye plane, or nearly does
const uint BACK = 2;      // the normal faces away, back faces are culled, and the surfel is not two-sided
const uint OUTSIDE = 3;   // outside the viewport, or without an area on it
const uint INVALID = 4;   // marked by a radius of 0, or with an image too large for floats
const uint LEVEL = 5;     // another level of detail is drawn at its position
const uint HIDDEN = 6;    // its cluster is behind the nearest surface everywhere
const uint DRAWN = 7;

#ifdef COMPUTE

layout(constant_id = 2) const bool COUNT = false;

layout(set = 2, binding = 5, std430) buffer Counts {
    uint culled[7];
    uint in_clusters; // of the culled ones, those of culled clusters
};

void count(uint reason) {
    if (COUNT && reason != DRAWN) atomicAdd(culled[reason], 1);
}

void count_cluster(uint reason, uint surfels) {
    if (!COUNT) return;
    atomicAdd(culled[reason], surfels);
    atomicAdd(in_clusters, surfels);
}

#endif
