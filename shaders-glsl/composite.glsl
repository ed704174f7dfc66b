// Composite: blends the picture over the target of a host and writes its depth where most of a pixel is covered (src/embed/composite.rs).
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

// Largest distance at which the filter of pixels covers pixels without a surface, px: Settings::filter_radius of the largest variance.
const int MOST_RADIUS = 6;

bool has_surface(ivec2 pixel) {
    if (HOST_DEPTH) return texelFetch(depth_image, pixel, 0).r != 0.0;
#ifdef WITH_NORMALS
    return texelFetch(normal_image, pixel, 0).xyz != vec3(0.0);
#else
    return true;
#endif
}

// The pixel, or the nearest one with a surface if only the filter of pixels covers it: depths and normals are not filtered.
ivec2 surface_pixel(ivec2 pixel, bool is_covered) {
    if (!is_covered || has_surface(pixel)) return pixel;
    ivec2 last = textureSize(picture_image, 0) - 1, nearest = pixel;
    int least = 2 * MOST_RADIUS * MOST_RADIUS + 1;
    for (int y = -MOST_RADIUS; y <= MOST_RADIUS; y++) {
        for (int x = -MOST_RADIUS; x <= MOST_RADIUS; x++) {
            ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), last);
            if (x * x + y * y < least && has_surface(at)) {
                least = x * x + y * y;
                nearest = at;
            }
        }
    }
    return nearest;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) - composite.origin;
    vec4 colour = texelFetch(picture_image, pixel, 0);
    // Some devices go on after a discard: without the condition they would search for a surface at every pixel beside the object.
    bool is_covered = is_drawn(colour.a);
    if (!is_covered) discard;
    out_image = over_host(colour);
    pixel = surface_pixel(pixel, is_covered);
#ifdef WITH_NORMALS
    out_normal = vec4(texelFetch(normal_image, pixel, 0).xyz, 1.0);
#endif
#ifdef WITH_IDS
    out_id = texelFetch(id_image, pixel, 0).r;
#endif
    if (HOST_DEPTH) gl_FragDepth = host_depth(composite.depth, texelFetch(depth_image, pixel, 0).r);
}

#endif
