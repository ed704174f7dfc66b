// Attribute on a tile: weighted sums, per pixel, over the splats that are not behind its depth. Splats are added in a fixed order, so that
// sums are deterministic.

#include "lib/attributes.glsl"
#include "lib/weights.glsl"

vec4 tile_sums0[ROWS], tile_sums1[ROWS]; // see lib/sums.glsl

// κ below which all pixels of the tile are occluded.
float attribute_cull_key;

// Adds a splat to the sums, if `is_splat`; `attribute0` is (normal or colour, weight). With fields, the normal is that of the tile's first pixel,
// and `change` is per px along x and y.
void add_attributes(
    TileSplat splat, vec4 attribute0, vec3 attribute1, mat2x3 change, vec4 corners, vec3 square, bool is_splat) {
    mat2 axes = mat2(square.xy, square.z * vec2(-square.y, square.x));
    for (uint r = 0; r < ROWS; r++) {
        vec2 d = vec2(lane_pixel(r)), m;
        float key, rank;
        bool has_fragment = tile_fragment(splat, d, m, key, rank) && is_splat;
        // Pixels without a visible surface get no attributes: this footprint is wider.
        has_fragment = has_fragment && depths[r] > 0.0 && ranked(key, rank) >= depths[r];
#ifdef BEHIND
        has_fragment = has_fragment && ranked(key, rank) < nearest_depths[r];
#endif
        float weight = attribute0.w;
        if (!OVERLAP) weight *= kernel(dot(m, m));
        if (FRAME_CORNERS && !OVERLAP) weight *= bilinear_weight(corners, axes, m);
        weight = has_fragment ? weight : 0.0;
        vec3 value = attribute0.xyz;
        if (FRAME_NORMAL_FIELDS) value = (value + change[0] * d.x) + change[1] * d.y;
        tile_sums0[r] += vec4(weight, weight * value);
        tile_sums1[r] += vec4(has_fragment ? weight * frame.key_gain * key : 0.0, weight * attribute1);
    }
}

void add_attribute_batch(uint count, uint id, uvec2 origin) {
    Splat splat = splat_of(id);
    vec2 variance = attribute_variance(variance_of(splat));
    TileSplat lane_splat = splat_on_tile(ellipse_of(splat, variance, clip_of(id)), vec2(origin) + 0.5);
    Attributes attributes = attributes_of(id);
    mat3 normals = mat3(0.0);
    if (FRAME_NORMAL_FIELDS) {
        normals = normals_on_tile(attributes.attribute0, attributes.field, lane_splat.kernel.u, lane_splat.kernel.v);
        attributes.attribute0 = normals[0];
    }
    vec4 attribute0 = vec4(attributes.attribute0, OVERLAP ? 1.0 : attributes.weight * amplitude_of(splat, variance));
    // Lanes beyond the batch may hold NaN, which a weight of 0 would not cancel.
    attribute0 = lane < count ? attribute0 : vec4(0.0);
    attributes.attribute1 = lane < count ? attributes.attribute1 : vec3(0.0);
    mat2x3 lane_change = lane < count ? mat2x3(normals[1], normals[2]) : mat2x3(0.0);
    uint s = 0;
    do {
        for (uint k = 0; k < UNROLLED; k++) {
            vec3 attribute1 = WIDE_SUMS1 ? shuffle(attributes.attribute1, s + k) : vec3(0.0);
            mat2x3 change = mat2x3(0.0);
            if (FRAME_NORMAL_FIELDS) change = mat2x3(shuffle(lane_change[0], s + k), shuffle(lane_change[1], s + k));
            vec4 corners = FRAME_CORNERS ? shuffle(attributes.corners, s + k) : vec4(1.0);
            vec3 square = FRAME_CORNERS ? shuffle(attributes.square, s + k) : vec3(1.0);
            add_attributes(shuffle(lane_splat, s + k), shuffle(attribute0, s + k), attribute1, change, corners, square,
                s + k < count);
        }
        s += UNROLLED;
    } while (s < count);
}

#define WALK walk_attribute
#ifndef ATTRIBUTE_STEPS
#define ATTRIBUTE_STEPS 26000
#endif
#define WALK_STEPS ATTRIBUTE_STEPS
#define WALK_CULL_KEY attribute_cull_key
#define WALK_BATCH(count, id) add_attribute_batch(count, id, origin)
#include "lib/walk.glsl"

// Sums attributes of the tile; `depths` are those of visibility.
void sum_attributes(uvec2 origin) {
    for (uint r = 0; r < ROWS; r++) {
        if (!is_resumed()) tile_sums0[r] = tile_sums1[r] = vec4(0.0);
        depths[r] = is_in_viewport(origin + lane_pixel(r)) ? depths[r] : 0.0;
    }
    // Slightly farther, so that equal depths count.
    attribute_cull_key = 0.999999 * least_depth();
    WORKGROUP_BARRIER();
    bool all_recorded = visited_count <= MOST_VISITED;
    uint first = all_recorded ? 0 : SCRATCH, end = all_recorded ? visited_count : SCRATCH;
    walk_attribute(origin, origin + TILE - 1, first, end, !all_recorded);
}
