// Attribute: weighted sums over the splats within ε of the nearest surface (zwicker2004 §6, second pass).
#version 450
#pragma variant CLIP_LINES VERTEX FRAGMENT
#pragma variant SUBGROUPS COMPUTE
#pragma variant BEHIND FRAGMENT
#pragma variant BEHIND_CLIP_LINES FRAGMENT
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require
#include "lib/tile_pass.glsl"

// Of the surface behind, for pass behind.
#ifdef BEHIND_CLIP_LINES
#define BEHIND
#define CLIP_LINES
#endif

#define VERTICES 3
#ifdef COMPUTE
#include "lib/frame.glsl"
#else
#include "lib/instance.glsl"
#endif
#include "lib/sums.glsl"
#define CLIP_ACCESS readonly
#include "lib/splat.glsl"
#include "lib/weights.glsl"

#ifdef COMPUTE

#define SUMS_ACCESS
#define STORES_SUMS
#define ATTRIBUTE_STEPS 62000
#include "lib/pixels.glsl"
#include "lib/stored_sums.glsl"
#include "lib/tile.glsl"
#include "lib/tile_attribute.glsl"

void main() {
    load_frame();
    uvec2 origin = tile_origin();
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        if (is_resumed()) load_sums(is_in_viewport(pixel) ? pixel_index(ivec2(pixel)) : 0, tile_sums0[r], tile_sums1[r]);
        depths[r] = is_in_viewport(pixel) ? uintBitsToFloat(visibility[pixel_index(ivec2(pixel))]) : 0.0;
    }
    visited_count = MOST_VISITED + 1;
    sum_attributes(origin);
    report_incomplete();
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        if (is_in_viewport(pixel)) store_sums(pixel_index(ivec2(pixel)), tile_sums0[r], tile_sums1[r]);
    }
}

#else
#include "lib/draw_splat.glsl"
#endif
#ifdef VERTEX

#include "lib/surfel_attributes.glsl"
#include "lib/surfel_weights.glsl"
#include "lib/surfel_normal_field.glsl"

layout(location = 4) flat out float height;
layout(location = 5) flat out vec3 attribute0;
layout(location = 6) flat out vec3 attribute1;
layout(location = 7) flat out vec4 corners;
layout(location = 8) flat out vec4 square;
layout(location = 14) flat out vec4 field_row;

void main() {
    uint i = surfel_index();
    Splat splat = splat_of(i);
    vec2 variance = attribute_variance(variance_of(splat));
    write_splat_vertex(i, splat, variance, gl_VertexIndex % 3);
    mat2 axes;
    height = surfel_weight(i, splat, corners, axes);
    if (!OVERLAP) height *= amplitude_of(splat, variance);
    square = vec4(axes[0], axes[1]);
    surfel_attributes(i, splat.epsilon, attribute0, attribute1);
    if (FRAME_NORMAL_FIELDS) field_row = stored_field(attribute0, normal_field(i, splat));
}

#endif
#ifdef FRAGMENT

#include "lib/normal_field.glsl"

layout(location = 4) flat in float height;
layout(location = 5) flat in vec3 attribute0;
layout(location = 6) flat in vec3 attribute1;
layout(location = 7) flat in vec4 corners;
layout(location = 8) flat in vec4 square;
layout(location = 14) flat in vec4 field_row;

#ifdef BEHIND
layout(set = 1, binding = 9) uniform texture2D visibility_image;
#endif

layout(location = 0) out vec4 sum0;
layout(location = 1) out vec4 sum1;

void main() {
    vec2 m;
    float key, rank;
    evaluate_fragment(m, key, rank);
#ifdef BEHIND
    if (ranked(key, rank) >= texelFetch(visibility_image, ivec2(gl_FragCoord.xy), 0).r) discard;
#endif
    float weight = OVERLAP ? 1.0 : height * kernel(dot(m, m));
    if (CORNERS && !OVERLAP) weight *= bilinear_weight(corners, mat2(square.xy, square.zw), m);
    gl_FragDepth = ranked(key, rank);
    vec3 value = attribute0;
    if (FRAME_NORMAL_FIELDS) value += field_of(attribute0, field_row) * flat_kernel_coordinates();
    sum0 = weight * vec4(1.0, value);
    sum1 = weight * vec4(SUM_DEPTH ? frame.key_gain * key : 0.0, attribute1);
}

#endif
