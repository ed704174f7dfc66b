// Covered: lists the tiles that boxes of splats overlap, for a dispatch over these. Boxes of the hierarchy stand for those of their splats once
// they are as small as a few tiles.
#version 450
#pragma variant SUBGROUPS COMPUTE
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#define BOX_ACCESS readonly
#include "lib/box.glsl"
#include "lib/hierarchy.glsl"
#define COVERED_ACCESS
#include "lib/covered_tiles.glsl"

layout(local_size_x = 64) in;

// An invocation finds the covered tiles among so many of a row, a bit each.
const uint STRIP = 16;
// Least level that is visited, whose nodes have eight splats: below it are those that face away, too, which pass boxes has left out.
const uint LEAF_LEVEL = 1;
// Largest side of the boxes that stand for those below them, px.
const uint FINE_SIDE = 2 * TILE;
// Nodes that an invocation visits; where there are more, all of its tiles are listed.
const uint MOST_NODES = 2048;

// Bits from `low` to `high`, inclusive.
uint bits(uint low, uint high) {
    return (2u << high) - (1u << low);
}

// The tiles that a box overlaps of the strip whose first tile is `first`.
uint tiles_of(Box box, uvec2 first) {
    uvec4 tiles = corners(box) / TILE;
    uint last = first.x + STRIP - 1;
    bool overlaps = tiles.x <= last && tiles.z >= first.x && tiles.y <= first.y && tiles.w >= first.y;
    return overlaps ? bits(max(tiles.x, first.x) - first.x, min(tiles.z, last) - first.x) : 0;
}

bool is_fine(Box box) {
    uvec4 bounds = corners(box);
    return all(lessThan(bounds.zw - bounds.xy, uvec2(FINE_SIDE)));
}

// The tiles of the strip that boxes overlap, depth first. Nodes that add no tile are not opened.
uint covered_tiles(uvec2 first, uint all) {
    uint root = hierarchy.level, level = root, node = FAN_OUT * hierarchy.group, found = 0, visited = 0;
    bool more = true;
    // Not do … while: on lavapipe, that would go on to change the variables of lanes that have left it.
    while (more && found != all && visited < MOST_NODES) {
        Box box = load_box(hierarchy.starts[level] + node);
        uint tiles = tiles_of(box, first) & all;
        bool opens = (tiles & ~found) != 0 && level > LEAF_LEVEL && !is_fine(box);
        found |= opens ? 0 : tiles;
        // The first child, or the next node that is no descendant.
        uint up = opens ? 0 : min(uint(findLSB(~node)) / 3, root - level);
        more = opens || level + up < root || (node >> 3 * up) % FAN_OUT != FAN_OUT - 1;
        node = opens ? FAN_OUT * node : (node >> 3 * up) + 1;
        level = opens ? level - 1 : level + up;
        visited++;
    }
    return more ? all : found;
}

void main() {
    uint i = gl_GlobalInvocationID.x + gl_GlobalInvocationID.y * gl_NumWorkGroups.x * gl_WorkGroupSize.x;
    uvec2 counts = tile_counts(), strips = uvec2((counts.x + STRIP - 1) / STRIP, counts.y);
    uint rows = (counts.x * counts.y + MOST_COLUMNS - 1) / MOST_COLUMNS;
    if (i == 0) {
        covered.rows = rows;
        covered.layers = 1;
    }
    if (i >= strips.x * strips.y) return;
    uvec2 first = uvec2(STRIP * (i % strips.x), i / strips.x);
    uint count = min(counts.x - first.x, STRIP), found = covered_tiles(first, bits(0, count - 1));
    uint place = atomicAdd(covered.listed_count, bitCount(found));
    for (uint k = 0; k < count; k++) {
        bool is_covered = (found >> k & 1u) != 0;
        covered.tiles[tile_index(first) + k].key = is_covered ? MARKED : 0;
        if (is_covered) covered.tiles[place++].listed = first.x + k | first.y << 16;
    }
    atomicMax(covered.columns, columns_of(place, rows));
}

#endif
