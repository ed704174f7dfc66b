// Attribute: weighted sums over the splats within ε of the nearest surface (zwicker2004 §6, second pass).
#version 450
#extension GL_GOOGLE_include_directive : require

#include "lib/frame.glsl"
#include "lib/sums.glsl"
#define SPLAT_ACCESS readonly
#include "lib/splat.glsl"
#include "lib/draw_splat.glsl"

#ifdef VERTEX

layout(set = 0, binding = 3, std430) readonly buffer Normals { float normals[]; };
layout(set = 0, binding = 5, std430) readonly buffer Colours { uint colours[]; };

layout(location = 3) flat out float amplitude;
layout(location = 4) flat out vec3 first;
layout(location = 5) flat out vec3 second;

vec3 srgb_to_linear(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

vec3 colour_of(uint i) {
    if (COLOURS == COLOURS_LINEAR)
        return uintBitsToFloat(uvec3(colours[3 * i], colours[3 * i + 1], colours[3 * i + 2]));
    return srgb_to_linear(unpackUnorm4x8(colours[i]).rgb);
}

void main() {
    uint i = gl_VertexIndex / 3;
    Splat splat = splats[i];
    amplitude = place_splat(splat, frame.attribute_lowpass, gl_VertexIndex % 3);
    vec3 normal = SUM_NORMALS ? splat.side * vec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]) : vec3(0.0);
    vec3 colour = COLOURS != COLOURS_NONE ? colour_of(i) : vec3(0.0);
    first = SUM_NORMALS ? normal : colour;
    second = colour;
}

#endif
#ifdef FRAGMENT

layout(location = 3) flat in float amplitude;
layout(location = 4) flat in vec3 first;
layout(location = 5) flat in vec3 second;

layout(location = 0) out vec4 sum0;
layout(location = 1) out vec4 sum1;

void main() {
    float key;
    float weight = amplitude * exp(-0.5 * splat_fragment(key));
    gl_FragDepth = key;
    sum0 = weight * vec4(1.0, first);
    sum1 = weight * vec4(SUM_DEPTH ? frame.key_gain * key : 0.0, second);
}

#endif
