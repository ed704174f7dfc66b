// Composite: blends the picture over the target of a host and writes its depth (src/embed/mod.rs).
#version 450
#pragma variant IMAGES FRAGMENT
#pragma variant NORMALS FRAGMENT
#pragma variant IMAGES_NORMALS FRAGMENT
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
    ivec2 origin; // of the picture in the target of the host, px
    uvec2 size;   // of the picture, px
    vec4 depth;   // see host_depth
} composite;

#if defined(NORMALS) || defined(IMAGES_NORMALS) || defined(NORMALS_IDS)
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

#if defined(IMAGES) || defined(IMAGES_NORMALS)

layout(set = 0, binding = 1) uniform texture2D picture_image;
layout(set = 0, binding = 2) uniform texture2D normal_image;
layout(set = 0, binding = 3) uniform texture2D depth_image;

vec4 image_at(ivec2 pixel) { return texelFetch(picture_image, pixel, 0); }
vec3 normal_at(ivec2 pixel) { return texelFetch(normal_image, pixel, 0).xyz; }
float depth_at(ivec2 pixel) { return texelFetch(depth_image, pixel, 0).r; }

#else

layout(set = 0, binding = 0, std430) readonly buffer FramePicture { uint picture[]; }; // floats: colours, then normals, then depths; then ids

uint pixel_index(ivec2 pixel) { return uint(pixel.y) * composite.size.x + uint(pixel.x); }
uint pixel_count() { return composite.size.x * composite.size.y; }

vec4 image_at(ivec2 pixel) {
    uint i = 4 * pixel_index(pixel);
    return uintBitsToFloat(uvec4(picture[i], picture[i + 1], picture[i + 2], picture[i + 3]));
}

vec3 normal_at(ivec2 pixel) {
    uint i = 4 * pixel_count() + 3 * pixel_index(pixel);
    return uintBitsToFloat(uvec3(picture[i], picture[i + 1], picture[i + 2]));
}

#ifdef WITH_NORMALS
const uint DEPTH_START = 7;
#else
const uint DEPTH_START = 4;
#endif

float depth_at(ivec2 pixel) { return uintBitsToFloat(picture[DEPTH_START * pixel_count() + pixel_index(pixel)]); }
uint id_at(ivec2 pixel) { return picture[(DEPTH_START + (HOST_DEPTH ? 1 : 0)) * pixel_count() + pixel_index(pixel)]; }

#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - composite.origin;
    vec4 colour = image_at(pixel);
    if (colour.a == 0.0) discard;
    out_image = over_host(colour);
#ifdef WITH_NORMALS
    out_normal = vec4(normal_at(pixel), 1.0);
#endif
#ifdef WITH_IDS
    out_id = id_at(pixel);
#endif
    if (HOST_DEPTH) gl_FragDepth = host_depth(composite.depth, depth_at(pixel));
}

#endif
