// Cull: lists the clusters of surfels that may have splats, by their bounding boxes and normal cones. The CPU has culled groups of them
// (src/frame/group_culling.rs). OCCLUSION_CULLING: those that were hidden in the last frame wait for pass hidden.
#version 450
#pragma variant TILES
#extension GL_GOOGLE_include_directive : require

uint group_instance;
#define INSTANCE group_instance
#include "lib/instance.glsl"
#include "lib/footprint_kind.glsl"
#ifdef TILES
#include "lib/box.glsl"
#endif
#define VISIBLE_ACCESS
#include "lib/visible_clusters.glsl"

#ifdef COMPUTE

#include "lib/cull_reasons.glsl"
#include "lib/levels.glsl"

layout(local_size_x = 64) in;

#include "lib/cluster_bounds.glsl"
#ifdef TILES
#define HIDDEN_ACCESS
#include "lib/hidden_clusters.glsl"
layout(set = 1, binding = 6, std430) writeonly buffer Boxes { Box boxes[]; };
#endif

layout(constant_id = 1) const bool CULL_BACK = false;
layout(constant_id = 64) const bool BOUNDED = false; // the scene has bounds of its clusters

// Margin of squared distances, for rounding of the box's corners and of the distances.
const float LEVEL_ROUNDING = 1e-4;

// Whether all splats of discs with centres in the box are beyond the side of the viewport at pixel `side` of an axis; `outward` is −1 for the
// low side.
//
// A splat extends by at most reach·f√(1 + t²)/z + margin, px, from the projection f·t of its centre at distance z, where f is the focal length.
// Let the plane through the eye and the side, moved outwards by the margin, be at t₀. A centre farther than 2·reach beyond it, with
// z ≥ 2·reach, has t − t₀ > 2·reach·√(1 + t₀²)/z. As √(1 + t²) ≤ √(1 + t₀²) + t − t₀, its splat ends beyond t₀.
bool is_beyond(uint axis, float outward, float side, float reach, float margin, vec3 low, vec3 high) {
    float moved = side + outward * margin;
    vec3 gradient = view.rows_hi[axis].xyz;
    if (PERSPECTIVE) gradient -= moved * view.rows_hi[2].xyz;
    float constant = PERSPECTIVE ? 0.0 : view.rows_hi[axis].w - moved;
    float least = bounds_on(outward * gradient, outward * constant, low, high).x;
    return least > 2.0 * reach * length(gradient);
}

bool is_outside(float reach, vec3 low, vec3 high) {
    if (PERSPECTIVE && !(bounds_on(view.rows_hi[2].xyz, 0.0, low, high).x >= 2.0 * reach * length(view.rows_hi[2].xyz))) return false;
    float margin = splat_margin();
    for (uint axis = 0; axis < 2; axis++) {
        if (is_beyond(axis, -1.0, 0.0, reach, margin, low, high)) return true;
        if (is_beyond(axis, 1.0, frame.viewport[axis], reach, margin, low, high)) return true;
    }
    return false;
}

// Whether the normals in the cone face away from the eye everywhere in the box.
bool faces_away(Cluster cluster, float moved, vec3 low, vec3 high) {
    if (!PERSPECTIVE) return dot(cluster.axis.xyz, view.forward_hi.xyz) >= cluster.high.w + ROUNDING;
    float farthest = length(max(abs(low), abs(high))) + moved;
    return bounds_on(cluster.axis.xyz, 0.0, low, high).x - moved >= (cluster.high.w + ROUNDING) * farthest;
}

// Whether surfels of a level with centres in the box may be of the level that is drawn there. Their cells lie within the box widened by the
// side; the nearest point of a cell is not beyond the farthest corner of the box.
bool may_be_drawn(uint level, vec3 low, vec3 high) {
    vec3 farthest = max(abs(low), abs(high));
    if (level > 0 && !suffices_at(cell_side(level), (1.0 + LEVEL_ROUNDING) * dot(farthest, farthest))) return false;
    if (is_coarsest(level)) return true;
    float side = cell_side(level + 1);
    return !suffices_at(side, (1.0 - LEVEL_ROUNDING) * squared_distance_to(low - side, high + side));
}

// Whether surfels from `first` to `last` of the scene, with centres in the box, may be of the levels that are drawn there.
bool has_drawn_level(uint first, uint last, vec3 low, vec3 high) {
    uint beyond = level_of(last);
    for (uint level = level_of(first); level <= beyond; level++) {
        if (may_be_drawn(level, low, high)) return true;
    }
    return false;
}

// Cull reason of all of the cluster's surfels, from `first` to `last` of the scene; DRAWN if some may be drawn.
uint cull_reason(Cluster cluster, uint first, uint last) {
    float radius = cluster.low.w;
    if (radius < 0.0) return INVALID;
    CentreBox centres = centres_of(cluster);
    vec3 low = centres.low, high = centres.high;
    if (HAS_LEVELS && !has_drawn_level(first, last, low, high)) return LEVEL;
    // Discs may be moved by ε along the camera's axis.
    float moved = frame.epsilon * radius;
    if (PERSPECTIVE && bounds_on(view.rows_hi[2].xyz, 0.0, low, high).y + moved * length(view.rows_hi[2].xyz) < 0.0) return BEHIND;
    if (CULL_BACK && faces_away(cluster, moved, low, high)) return BACK;
    // An affine image extends by the radius times largest_stretch; a perspective one, whose nearest point is at z/2 at least, by twice the radius.
    // A third radius is a margin for rounding.
    return is_outside(3.0 * largest_stretch() * radius + moved, low, high) ? OUTSIDE : DRAWN;
}

// A workgroup per group, an invocation per cluster.
void main() {
    uint index = CLUSTER_COLUMNS * gl_WorkGroupID.y + gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
    if (index >= chunk.group_count) return;
    Group group = groups[index];
    if (lane >= group.count) return;
    if (index == 0 && lane == 0) layers = revealed_layers = 1;
    bool exists = group.instance != NO_INSTANCE;
    group_instance = exists ? group.instance : 0;
    uint cluster = group.first + lane, first = CLUSTER_SIZE * cluster, id = chunk.first_id + first;
    uint surfels = exists ? min(chunk.count - first, CLUSTER_SIZE) : 0;
    uint reason = exists ? DRAWN : OUTSIDE;
    if (exists && BOUNDED) reason = cull_reason(clusters[id / CLUSTER_SIZE], id, id + surfels - 1);
    uint slot = group.slot + lane;
#ifdef TILES
    uint node = chunk.first_node + slot;
    boxes[node] = Box(EMPTY_BOX.xyz, reason == DRAWN ? EMPTY_BOX.w : CULLED_CLUSTER);
    if (OCCLUSION_CULLING && exists && BOUNDED && reason == DRAWN) {
        bool was_hidden = hidden_clusters[hidden_index(group.instance, cluster)] != 0;
        float key = nearest_key_of(clusters[id / CLUSTER_SIZE]);
        // Not 0, as of culled clusters.
        uint bound = floatBitsToUint(key < NEVER_HIDDEN ? key : LEAST_BOUND);
        boxes[node] = Box(EMPTY_BOX.xy, bound, was_hidden ? CULLED_CLUSTER : EMPTY_BOX.w);
        // Pass hidden draws it, or counts it.
        if (was_hidden) return;
    }
#endif
    if (reason == DRAWN) {
        uint entry = atomicAdd(visible_count, 1);
        atomicMax(columns, min(entry + 1, CLUSTER_COLUMNS));
        atomicMax(rows, entry / CLUSTER_COLUMNS + 1);
        visible_clusters[entry] = VisibleCluster(cluster, slot, group.instance);
    } else if (exists) {
        count_cluster(reason, surfels);
    }
}

#endif
