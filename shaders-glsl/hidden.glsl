// Hidden: tests clusters against the farthest depths of tiles, once the clusters that were not hidden in the last frame are drawn. Of the others
// it lists those that nothing hides in this frame, and the tiles that they may change. For the next frame it stores which clusters are hidden.
#version 450
#extension GL_GOOGLE_include_directive : require

uint group_instance;
#define INSTANCE group_instance
#include "lib/instance.glsl"
#include "lib/footprint_kind.glsl"
#include "lib/box.glsl"
#define VISIBLE_ACCESS
#include "lib/visible_clusters.glsl"

#ifdef COMPUTE

#include "lib/cull_reasons.glsl"
#include "lib/cluster_bounds.glsl"
#define HIDDEN_ACCESS writeonly
#include "lib/hidden_clusters.glsl"
#include "lib/open_tiles.glsl"
#include "lib/revealed_tiles.glsl"

layout(local_size_x = 64) in;

layout(set = 1, binding = 6, std430) buffer Boxes { Box boxes[]; };

// Most tiles of a cluster that may be hidden.
const uint MOST_TILES = 1024;

// Tiles from `first` to `last`, inclusive.
struct Tiles {
    uvec2 first;
    uvec2 last;
};

// Bounds of the pixels of an axis with fragments of discs whose centres are in the box. Let c be the projection of a centre at distance z. Its
// disc reaches beyond the plane through the eye at c − e only if e ≤ reach·|gradient at c| / (z − reach).
vec2 pixels_of(uint axis, CentreBox box, float reach) {
    vec3 row = view.rows_hi[axis].xyz, depth = view.rows_hi[2].xyz;
    vec2 bounds = vec2(1e30, -1e30);
    for (uint k = 0; k < 8; k++) {
        vec3 corner = mix(box.low, box.high, notEqual(uvec3(k) & uvec3(1, 2, 4), uvec3(0)));
        float pixel = PERSPECTIVE ? dot(row, corner) / dot(depth, corner) : dot(row, corner) + view.rows_hi[axis].w;
        bounds = vec2(min(bounds.x, pixel), max(bounds.y, pixel));
    }
    if (!PERSPECTIVE) return bounds + vec2(-1.0, 1.0) * (reach * length(row) + splat_margin());
    float clear = bounds_on(depth, 0.0, box.low, box.high).x - reach * length(depth);
    vec2 extent = reach / clear * vec2(length(row - bounds.x * depth), length(row - bounds.y * depth));
    return bounds + vec2(-1.0, 1.0) * (extent + splat_margin());
}

Tiles tiles_of(Cluster cluster) {
    CentreBox box = centres_of(cluster);
    float reach = splat_reach(cluster);
    vec2 x = pixels_of(0, box, reach), y = pixels_of(1, box, reach), last = frame.viewport - 1.0;
    return Tiles(uvec2(clamp(vec2(x.x, y.x), vec2(0.0), last)) / TILE, uvec2(clamp(ceil(vec2(x.y, y.y)), vec2(0.0), last)) / TILE);
}

uint count_of(Tiles tiles) {
    uvec2 size = tiles.last - tiles.first + 1;
    return size.x * size.y;
}

uint tile_of(Tiles tiles, uint k) {
    uint columns = tiles.last.x - tiles.first.x + 1;
    return tile_index(tiles.first + uvec2(k % columns, k / columns));
}

// Whether splats with at most this κ may change a tile. Tiles with pixels at edges, which show the surface behind, have a key of 0.
bool may_change(float key, uint tile) {
    return !(key < uintBitsToFloat(open.tiles[tile].key));
}

// Whether the cluster may be hidden: it has a bound, and few tiles.
bool is_testable(float key, Tiles tiles) {
    return key < NEVER_HIDDEN && count_of(tiles) <= MOST_TILES;
}

bool is_hidden(float key, Tiles tiles) {
    if (!is_testable(key, tiles)) return false;
    for (uint k = 0; k < count_of(tiles); k++) {
        if (may_change(key, tile_of(tiles, k))) return false;
    }
    return true;
}

// Marks the tiles that splats with at most this κ may change; several invocations may mark the same tile.
void reveal(float key, Tiles tiles) {
    if (!is_testable(key, tiles)) {
        atomicOr(revealed.all, 1);
        return;
    }
    for (uint k = 0; k < count_of(tiles); k++) {
        uint tile = tile_of(tiles, k);
        if (may_change(key, tile)) atomicOr(revealed.tiles[tile].key, MARKED);
    }
}

// A workgroup per group, an invocation per cluster.
void main() {
    uint index = CLUSTER_COLUMNS * gl_WorkGroupID.y + gl_WorkGroupID.x, lane = gl_LocalInvocationID.x;
    if (index >= chunk.group_count) return;
    Group group = groups[index];
    if (lane >= group.count || group.instance == NO_INSTANCE) return;
    group_instance = group.instance;
    uint slot = group.slot + lane, node = chunk.first_node + slot;
    Box box = boxes[node];
    // Pass cull has left a κ in the boxes of clusters that it has not culled.
    if (box.z == 0) return;
    uint cluster = group.first + lane, first = CLUSTER_SIZE * cluster;
    Cluster bounds = clusters[(chunk.first_id + first) / CLUSTER_SIZE];
    float key = nearest_key_of(bounds);
    Tiles tiles = Tiles(uvec2(0), uvec2(0));
    // Near the eye, pixels are infinite or not numbers, which have no tile.
    if (key < NEVER_HIDDEN) tiles = tiles_of(bounds);
    bool hidden = is_hidden(key, tiles);
    hidden_clusters[hidden_index(group.instance, cluster)] = uint(hidden);
    if (box.w != CULLED_CLUSTER) return;
    if (hidden) {
        count_cluster(HIDDEN, min(chunk.count - first, CLUSTER_SIZE));
        return;
    }
    boxes[node] = Box(EMPTY_BOX.xy, box.z, EMPTY_BOX.w);
    reveal(key, tiles);
    uint entry = atomicAdd(revealed_count, 1);
    atomicMax(revealed_columns, min(entry + 1, CLUSTER_COLUMNS));
    atomicMax(revealed_rows, entry / CLUSTER_COLUMNS + 1);
    visible_clusters[visible_count + entry] = VisibleCluster(cluster, slot, group.instance);
}

#endif
