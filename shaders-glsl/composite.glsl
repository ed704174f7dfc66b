// Composite: blends the picture over the target of a host and writes its depth (src/embed/mod.rs).
#version 450
#pragma variant NORMALS FRAGMENT
#pragma variant IDS FRAGMENT
#pragma variant NORMALS_IDS FRAGMENT
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef VERTEX
#include "lib/full_screen.glsl"
#endif
#ifdef FRAGMENT

layout(constant_id = 0) const bool PERSPECTIVE = true;

#include "lib/host.glsl"

layout(push_constant) uniform Composite {
    vec4 depth;   // see host_depth
    ivec2 origin; // of the picture in the target of the host, px
} composite;

#if defined(NORMALS) || defined(NORMALS_IDS)
#define WITH_NORMALS
#endif
#if defined(IDS) || defined(NORMALS_IDS)
#define WITH_IDS
#endif

// The pipeline remaps these to the locations of the host.
layout(location = 0) out vec4 out_image;
#ifdef WITH_NORMALS
layout(location = 1) out vec4 out_normal;
#endif
#ifdef WITH_IDS
layout(location = 2) out uint out_id;
#endif

layout(set = 0, binding = 1) uniform texture2D picture_image;
layout(set = 0, binding = 2) uniform texture2D normal_image;
layout(set = 0, binding = 3) uniform texture2D depth_image;
#ifdef WITH_IDS
layout(set = 0, binding = 4) uniform utexture2D id_image;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - composite.origin;
    vec4 colour = texelFetch(picture_image, pixel, 0);
    if (colour.a == 0.0) discard;
    out_image = over_host(colour);
#ifdef WITH_NORMALS
    out_normal = vec4(texelFetch(normal_image, pixel, 0).xyz, 1.0);
#endif
#ifdef WITH_IDS
    out_id = texelFetch(id_image, pixel, 0).r;
#endif
    if (HOST_DEPTH) gl_FragDepth = host_depth(composite.depth, texelFetch(depth_image, pixel, 0).r);
}

#endif
