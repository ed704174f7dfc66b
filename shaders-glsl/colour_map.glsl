// Colour map: maps a scalar image to the colours of its PNG (src/formats/image/mod.rs).
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef VERTEX
#include "lib/full_screen.glsl"
#endif
#ifdef FRAGMENT

#include "lib/srgb.glsl"

layout(constant_id = 6) const uint SHADING = 0;
const uint NORMAL = 2, DEPTH = 3;

layout(push_constant) uniform ScalarOptions {
    float least_alpha;
    uint opaque;
} options;

layout(set = 0, binding = 0) uniform texture2D screen; // scalar times α, α
layout(set = 0, binding = 1, std430) readonly buffer ValueRange {
    uint least;
    uint greatest;
} range;
layout(set = 0, binding = 2, std430) readonly buffer MapColours { uint map_colours[]; }; // sRGB codes from 0 to 1, red lowest

layout(location = 0) out vec4 colour;

// Inverse of ordered_bits in range.glsl.
float float_of_bits(uint bits) {
    return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}

vec3 map_colour(float t) {
    int last = map_colours.length() - 1;
    float position = clamp(t, 0.0, 1.0) * float(last);
    int i = min(int(position), last - 1);
    return mix(unpackUnorm4x8(map_colours[i]).rgb, unpackUnorm4x8(map_colours[i + 1]).rgb, position - float(i));
}

// sRGB codes of a value, from 0 to 1.
vec3 codes_of(vec3 value) {
    if (SHADING == NORMAL) return 0.5 * value + 0.5;
    float greatest = float_of_bits(~range.greatest);
    if (SHADING == DEPTH) {
        float least = float_of_bits(range.least);
        float scale = greatest > least ? 0.9 / (greatest - least) : 0.0;
        return vec3(1.0 - (value.x - least) * scale);
    }
    return map_colour(value.x / max(greatest, 1.0));
}

void main() {
    vec4 texel = texelFetch(screen, ivec2(gl_FragCoord.xy), 0);
    if (texel.a < options.least_alpha) discard;
    vec3 rgb = srgb_to_linear(clamp(codes_of(texel.rgb / texel.a), 0.0, 1.0));
    float alpha = options.opaque != 0u ? 1.0 : texel.a;
    colour = vec4(alpha * rgb, alpha);
}

#endif
