// Composite: the picture over a host's target, with the depth that the host's own surfaces have (src/embed/mod.rs).
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
    ivec2 origin; // of the picture in the host's target, px
    uvec2 size;   // of the picture, px
    vec4 depth;   // see host_depth
} composite;

#if defined(NORMALS) || defined(IMAGES_NORMALS) || defined(NORMALS_IDS)
#define WITH_NORMALS
#endif
#if defined(IDS) || defined(NORMALS_IDS)
#define WITH_IDS
#endif

// The host's locations take the place of these.
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

vec4 image_at(ivec2 at) { return texelFetch(picture_image, at, 0); }
vec3 normal_at(ivec2 at) { return texelFetch(normal_image, at, 0).xyz; }
float depth_at(ivec2 at) { return texelFetch(depth_image, at, 0).r; }

#else

layout(set = 0, binding = 0, std430) readonly buffer FramePicture { uint picture[]; }; // floats: colour, then normals, then depths; then numbers

uint pixel(ivec2 at) { return uint(at.y) * composite.size.x + uint(at.x); }
uint pixels() { return composite.size.x * composite.size.y; }

vec4 image_at(ivec2 at) {
    uint i = 4 * pixel(at);
    return uintBitsToFloat(uvec4(picture[i], picture[i + 1], picture[i + 2], picture[i + 3]));
}

vec3 normal_at(ivec2 at) {
    uint i = 4 * pixels() + 3 * pixel(at);
    return uintBitsToFloat(uvec3(picture[i], picture[i + 1], picture[i + 2]));
}

#ifdef WITH_NORMALS
const uint DEPTHS = 7;
#else
const uint DEPTHS = 4;
#endif

float depth_at(ivec2 at) { return uintBitsToFloat(picture[DEPTHS * pixels() + pixel(at)]); }
uint id_at(ivec2 at) { return picture[(DEPTHS + (HOST_DEPTH ? 1 : 0)) * pixels() + pixel(at)]; }

#endif

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy) - composite.origin;
    vec4 seen = image_at(at);
    if (seen.a == 0.0) discard;
    out_image = over_host(seen);
#ifdef WITH_NORMALS
    out_normal = vec4(normal_at(at), 1.0);
#endif
#ifdef WITH_IDS
    out_id = id_at(at);
#endif
    if (HOST_DEPTH) gl_FragDepth = host_depth(composite.depth, depth_at(at));
}

#endif
