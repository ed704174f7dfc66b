// Darken: multiplies the colours of a host's target by those of a picture (src/embed/depth_shading).
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef VERTEX
#include "lib/full_screen.glsl"
#endif
#ifdef FRAGMENT

layout(push_constant) uniform Darken {
    ivec2 origin; // of the picture in the target of the host, px
} darken;

layout(set = 0, binding = 1) uniform texture2D picture_image;

// The pipeline remaps this to the location of the host.
layout(location = 0) out vec4 factor;

void main() {
    factor = texelFetch(picture_image, ivec2(gl_FragCoord.xy) - darken.origin, 0);
}

#endif
