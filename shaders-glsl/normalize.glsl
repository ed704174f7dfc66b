// Normalize: divides the sums by Σw and shades (zwicker2004 §6, third pass; equation 2's normalization).
#version 450
#extension GL_GOOGLE_include_directive : require

#include "lib/frame.glsl"
#include "lib/sums.glsl"
#include "lib/shading.glsl"

#ifdef VERTEX

void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.0, 1.0);
}

#endif
#ifdef FRAGMENT

#extension GL_EXT_samplerless_texture_functions : require

layout(constant_id = 6) const uint SHADING = 0;
const uint LIT = 0, COLOUR = 1, NORMAL = 2, DEPTH = 3;

layout(set = 0, binding = 1) uniform texture2D visibility;
layout(set = 0, binding = 2) uniform texture2D sums0;
layout(set = 0, binding = 3) uniform texture2D sums1;

layout(location = 0) out vec4 image;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out float out_depth;

// Unit vector from the surface to the eye at this pixel.
vec3 to_eye() {
    vec3 ray = gl_FragCoord.x * frame.ray_hi[0].xyz + gl_FragCoord.y * frame.ray_hi[1].xyz + frame.ray_hi[2].xyz;
    return PERSPECTIVE ? -normalize(ray) : -frame.forward_hi.xyz;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 s0 = texelFetch(sums0, pixel, 0);
    image = frame.background;
    out_normal = vec4(0.0);
    out_depth = 0.0;
    // Only what visibility wrote is there: the attribute footprint is wider and would bloat the outline.
    if (!(texelFetch(visibility, pixel, 0).r > 0.0 && s0.r > 0.0)) return;

    vec4 s1 = SUM_DEPTH || (SUM_NORMALS && COLOURS != COLOURS_NONE) ? texelFetch(sums1, pixel, 0) : vec4(0.0);
    vec3 view = to_eye();
    vec3 normal = vec3(0.0);
    // Opposite normals that cancel leave no direction.
    if (SUM_NORMALS) normal = length(s0.gba) < 1e-6 * s0.r ? view : normalize(s0.gba);
    vec3 colour = frame.albedo.rgb;
    if (COLOURS != COLOURS_NONE) colour = (SUM_NORMALS ? s1.gba : s0.gba) / s0.r;
    float key = s1.r / (s0.r * frame.key_gain);
    float depth = 0.0;
    if (SUM_DEPTH) depth = PERSPECTIVE ? frame.near / key : frame.near + (1.0 - key) / frame.key_slope;

    vec3 shaded;
    if (SHADING == LIT) shaded = lit(colour, normal, view);
    if (SHADING == COLOUR) shaded = colour;
    if (SHADING == NORMAL) shaded = normal;
    if (SHADING == DEPTH) shaded = vec3(depth);
    image = vec4(shaded, 1.0);
    out_normal = vec4(normal, 0.0);
    out_depth = depth;
}

#endif
