// Normalize: divides the sums by Σw and shades (zwicker2004 §6, third pass; equation 2's normalization).
#version 450
#pragma variant COVERAGE
#pragma variant SUBPASS FRAGMENT
#pragma variant SUBPASS_COVERAGE FRAGMENT
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#include "lib/frame.glsl"
#include "lib/picture_pixel.glsl"

// In a subpass of a host: outputs go to the host's colour and depth attachments.
#if defined(SUBPASS) || defined(SUBPASS_COVERAGE)
#define IN_SUBPASS
#endif
#ifdef SUBPASS_COVERAGE
#define COVERAGE
#endif

#ifdef COVERAGE
layout(set = 1, binding = 5, std430) readonly buffer Coverage { uint coverage[]; }; // one bit per sample
#endif

// Covered part of pixel i.
float alpha_of(uint i) {
#ifdef COVERAGE
    return bitCount(coverage[i]) / 16.0;
#else
    return 1.0;
#endif
}

#ifdef COMPUTE

#include "lib/pixel_group.glsl"
#include "lib/pixels.glsl"
#include "lib/stored_sums.glsl"

void main() {
    ivec2 pixel = invocation_pixel(), size = picture_size();
    if (any(greaterThanEqual(pixel, size))) return;
    uint i = uint(pixel.y * size.x + pixel.x);
    vec4 s0, s1;
    load_sums(i, s0, s1);
    store_pixel(pixel, normalize_pixel(vec2(pixel) + 0.5, visibility[i] != 0u, alpha_of(i), s0, s1));
}

#endif
#ifdef VERTEX
#include "lib/full_screen.glsl"
#endif
#if defined(FRAGMENT) && defined(IN_SUBPASS)

#include "lib/host.glsl"

layout(constant_id = 42) const bool VISIBLE_BY_SUMS = false; // pixels outside visibility have no sums

layout(set = 1, binding = 12, input_attachment_index = 0) uniform subpassInput visibility_input;
layout(set = 1, binding = 13, input_attachment_index = 1) uniform subpassInput sums0_input;
layout(set = 1, binding = 14, input_attachment_index = 2) uniform subpassInput sums1_input;

layout(push_constant) uniform Subpass {
    vec4 depth; // see host_depth
} host;

layout(location = 0) out vec4 out_image;
layout(location = 1) out vec4 out_normal;

void main() {
    // Pixel centre, also with per-sample shading.
    vec2 centre = floor(gl_FragCoord.xy) + 0.5 - frame.origin;
    uvec2 texel = uvec2(centre);
    vec4 s0 = subpassLoad(sums0_input);
    vec4 s1 = SUM_DEPTH || WIDE_SUMS1 ? subpassLoad(sums1_input) : vec4(0.0);
    bool visible = VISIBLE_BY_SUMS ? s0.x > 0.0 : subpassLoad(visibility_input).r > 0.0;
    float alpha = alpha_of(texel.y * uint(frame.viewport.x) + texel.x);
    // Pixels of the other draw are not shaded.
    Pixel pixel = normalize_pixel(centre, visible && is_drawn(alpha), alpha, s0, s1);
    if (pixel.image.a == 0.0) discard;
    out_image = over_host(pixel.image);
    out_normal = vec4(pixel.normal, 1.0);
    if (HOST_DEPTH) gl_FragDepth = host_depth(host.depth, pixel.depth);
}

#elif defined(FRAGMENT)

layout(set = 1, binding = 9) uniform texture2D visibility_image;
layout(set = 1, binding = 10) uniform texture2D sums0_image;
layout(set = 1, binding = 11) uniform texture2D sums1_image;

layout(location = 0) out vec4 image;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out float out_depth;

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    bool visible = texelFetch(visibility_image, texel, 0).r > 0.0;
    vec4 s1 = SUM_DEPTH || WIDE_SUMS1 ? texelFetch(sums1_image, texel, 0) : vec4(0.0);
    float alpha = alpha_of(texel.y * uint(frame.viewport.x) + texel.x);
    Pixel pixel = normalize_pixel(gl_FragCoord.xy, visible, alpha, texelFetch(sums0_image, texel, 0), s1);
    image = pixel.image;
    out_normal = vec4(pixel.normal, 0.0);
    out_depth = pixel.depth;
}

#endif
