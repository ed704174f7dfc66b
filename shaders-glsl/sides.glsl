// Sides: drops splats that face away from the eye where a surface that faces it hides them, lies at most a radius behind their centres, or is a
// little nearer in a pixel beside that of the centre: the far side of a closed surface, which would shine past outlines as if it faced the eye.
// Others are the back of an open surface, and open the tiles that they may change, if these have been drawn without them.
#version 450
#pragma variant TILES COMPUTE
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef TILES
#define VISIBLE_ACCESS readonly
#define PER_CLUSTER
#include "lib/visible_clusters.glsl"
#endif
#include "lib/instance.glsl"
#define MODIFIES_SPLATS
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"

#ifdef COMPUTE

#include "lib/beside.glsl"
#include "lib/cull_reasons.glsl"

layout(local_size_x = 64) in;

#ifdef TILES

#include "lib/box.glsl"
#include "lib/pixels.glsl"

layout(set = 0, binding = 19, std430) buffer SplatBoxes { Box splat_boxes[]; };

layout(constant_id = 71) const bool OPENS_TILES = false;

#include "lib/open_tiles.glsl"

// Most tiles of a splat that opens those alone; larger ones open all.
const uint MOST_OPENED = 4096;

// Opens the tiles that a splat may change; several invocations may open the same tile.
void open_tiles_of(Box box) {
    // Splats at a border whose fragments all lie outside the picture are drawn, and change no tile.
    if (is_empty(box)) return;
    uvec2 last_tile = tile_counts() - 1;
    uvec4 bounds = corners(box) / TILE;
    uvec2 low = min(bounds.xy, last_tile), high = min(bounds.zw, last_tile), size = high - low + 1;
    if (size.x * size.y > MOST_OPENED) {
        atomicOr(open.all, 1);
        return;
    }
    for (uint k = 0; k < size.x * size.y; k++) {
        uvec2 tile = low + uvec2(k % size.x, k / size.x);
        uint i = tile_index(tile);
        uint key = atomicOr(open.tiles[i].key, 0);
        if (nearest_key(box) > uintBitsToFloat(key)) atomicOr(open.tiles[i].key, MARKED);
    }
}

float front_key(uvec2 pixel) {
    return uintBitsToFloat(visibility[pixel_index(ivec2(pixel))] & ~FULL_PIXEL);
}

bool has_surfel(uint entry) {
    return entry < chunk.count && instance_index() < chunk.instance_count;
}

#else

layout(set = 1, binding = 9) uniform texture2D visibility_image;

float front_key(uvec2 pixel) {
    return texelFetch(visibility_image, ivec2(pixel), 0).r;
}

uint entry_of_invocation() {
    return gl_GlobalInvocationID.x;
}

bool has_surfel(uint entry) {
    return entry < chunk.count;
}

#endif

// A disc that reaches past an outline of its own surface lies close behind that surface, or is steep. On a surface with a radius of curvature of R
// disc radii, it is at most √(8 R) disc radii behind, and the tangent of its angle to the screen is at least √(R / 2). The limits meet at R = 32.
const float BEHIND_CENTRE = 16.0; // disc radii, or widths of a pixel where these are larger
const float STEEP = 4.0;          // tangent: 76°
const ivec2 BESIDE[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));

// κ of the point behind the centre by `offset`, relative to the distance in perspective, else in κ; moved back by ε as those of visibility are.
float key_behind(float key, float shift, float offset) {
    // At the eye, and behind it, κ is beyond all.
    return PERSPECTIVE ? farther_key(key, max(shift + offset, 1e-6 - 1.0)) : key - shift - offset;
}

// κ of the surface that faces the eye so many pixels from a centre.
float key_at(ivec2 centre, ivec2 offset) {
    return front_key(uvec2(clamp(centre + offset, ivec2(0), ivec2(frame.viewport) - 1)));
}

// Whether a surface that faces the eye hides a splat, or is the splat's own surface before an outline. A surface far before the splat that hides
// it only in part leaves the rest visible, as the rim of a bowl does with the far inside.
bool is_hidden(Splat splat) {
    float plane = plane_at(splat.plane_hi, splat.plane_lo, splat.offset), key = plane;
#ifdef TILES
    if (has_linear_depth()) key = world_key(key);
#else
    if (has_linear_depth()) key = key_at_distance(key);
#endif
    // ε, frame.epsilon radii, a radius, and the width of a pixel.
    float shift = PERSPECTIVE ? relative_epsilon(splat.epsilon) : abs(splat.epsilon), radius = shift / frame.epsilon;
    float width = PERSPECTIVE ? frame.pixel_width : frame.key_slope * frame.pixel_width;
    float own = key_behind(key, shift, 0.0), unit = max(radius, width);
    ivec2 centre = ivec2(anchor_of(splat));
    float at_centre = key_at(centre, ivec2(0));
    if (at_centre >= key_behind(key, shift, radius)) {
        float slope = length(splat.plane_hi.yz);
        if (PERSPECTIVE) slope /= has_linear_depth() ? plane + (DISTANT ? frame.distance_offset : 0.0) : inverse_depth(plane);
        if (slope > STEEP * width || at_centre <= key_behind(key, shift, -BEHIND_CENTRE * unit)) return true;
        int reach = int(min(radius / width, 1e6)) + 2;
        bool are_ends_hidden = true;
        for (int k = 0; k < 4; k++) are_ends_hidden = are_ends_hidden && key_at(centre, reach * BESIDE[k]) >= own;
        if (are_ends_hidden) return true;
    }
    // On the outline of the picture, triangles of a coarse mesh still face the eye where their normals, means of several, face away.
    if (at_centre == 0.0) return false;
    float nearest = key_behind(key, shift, -BEHIND_BESIDE * sqrt(unit * width));
    for (int k = 0; k < 4; k++) {
        float beside = key_at(centre, BESIDE[k]);
        if (beside >= own && beside <= nearest) return true;
    }
    return false;
}

void main() {
    uint entry = entry_of_invocation();
    if (!has_surfel(entry)) return;
    Splat splat = splat_of(entry);
    if (!is_drawn(splat) || !is_back(splat)) return;
    if (!is_hidden(splat)) {
#ifdef TILES
        if (OPENS_TILES) open_tiles_of(splat_boxes[splat_index(entry)]);
#endif
        return;
    }
    store_culled(splat_index(entry));
#ifdef TILES
    splat_boxes[splat_index(entry)] = EMPTY_BOX;
#endif
    count(BACK);
}

#endif
