// Fill: writes every pixel of a target (src/bench/ceilings.rs).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef VERTEX
#include "lib/full_screen.glsl"
#endif
#ifdef FRAGMENT

layout(push_constant) uniform FillOptions {
    vec4 scale; // of the values
} options;

layout(location = 0) out vec4 out_colour;

// Values that differ from pixel to pixel: memory compresses equal ones.
void main() {
    vec2 at = gl_FragCoord.xy;
    out_colour = vec4(at, at.x * at.y, 1.0) * options.scale;
}

#endif
