// Shade: lights the final level 0 pixel by pixel and writes picture, normal, depth and id (marroquim2008 §3.4). With RECONSTRUCT it does the
// last step of push, too.
#version 450
#pragma variant LOOKUPS
#pragma variant STORE_IDS
#pragma variant LOOKUPS_STORE_IDS
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pixel_group.glsl"
#include "lib/pyramid.glsl"
#include "lib/level.glsl"
#include "lib/camera_rays.glsl"
#include "lib/shading.glsl"
#include "lib/background.glsl"
#include "lib/lattice.glsl"

PYRAMID_TO_READ(2, final)
PYRAMID_TO_READ(3, from)

#include "lib/reconstruction.glsl"
#include "lib/filled_tiles.glsl"

layout(constant_id = 48) const bool RECONSTRUCT = false; // level 0 is reconstructed here: push does not store it

layout(constant_id = 25) const bool MATERIALS = false; // points have materials

#if defined(LOOKUPS) || defined(LOOKUPS_STORE_IDS)
#define WITH_LOOKUPS
#include "lib/texture.glsl"
#include "lib/materials.glsl"
#endif

#include "lib/output_images.glsl"

#if defined(STORE_IDS) || defined(LOOKUPS_STORE_IDS)
layout(set = 1, binding = 21, r32ui) writeonly uniform uimage2D id_output;
#endif

layout(constant_id = 31) const bool COVERAGE = false; // α is the covered part of a pixel, not whether its centre is covered

// Widening of a disc's variance for coverage, px²: push's widening at half the side of a pixel. Narrower discs leave holes; wider ones
// reach beyond the outline.
const float COVERAGE_WIDENING = 0.0625;

// Mask of the pixel's samples inside the disc with this centre, px, which lies e px from the pixel's.
uint covered_by(Sample s, vec2 centre, vec2 e) {
    uint mask = 0;
    for (uint k = 0; k < SAMPLES; k++) mask |= uint(radii2(s, centre, sample_position(k) - e, COVERAGE_WIDENING) <= 1.0) << k;
    return mask;
}

// Covered part of a pixel that has a disc: samples inside any disc of the pixel and its neighbours, hidden ones too, and at least one. 1 if
// all neighbours have discs.
float coverage_of(ivec2 pixel) {
    uint mask = 0;
    bool inner = true;
    for (int k = 0; k < 9; k++) {
        ivec2 neighbour = pixel + ivec2(k % 3, k / 3) - 1;
        if (is_within(picture_size(), neighbour)) inner = inner && load_final(neighbour).near > 0.0;
    }
    if (inner) return 1.0;
    for (int k = 0; k < 9; k++) {
        ivec2 neighbour = pixel + ivec2(k % 3, k / 3) - 1;
        if (!is_within(picture_size(), neighbour)) continue;
        Sample s = load_final(neighbour);
        vec2 e = vec2(neighbour - pixel) + s.displacement;
        if (s.near > 0.0) mask |= covered_by(s, level_centre(0, pixel) + e, e);
    }
    return max(bitCount(mask), 1) / float(SAMPLES);
}

void main() {
    ivec2 pixel = LISTED_PIXEL(filled, 0);
    if (!is_within(picture_size(), pixel)) return;
    Sample s;
    if (RECONSTRUCT) s = reconstructed(pixel);
    else s = load_final(pixel);
    vec4 image = empty_pixel();
    if (s.near > 0.0) {
        vec2 centre = vec2(pixel) + 0.5;
        vec3 ray = centre.x * view.ray_hi[0].xyz + centre.y * view.ray_hi[1].xyz + view.ray_hi[2].xyz;
        vec3 to_eye = PERSPECTIVE ? -normalize(ray) : -view.forward_hi.xyz;
        vec3 colour = SUM_COLOURS ? s.colour : frame.albedo.rgb;
        Shine shine = FRAME_SHINE;
#ifdef WITH_LOOKUPS
        if (TEXTURE) colour = texture_colour(pixel, s);
        if (MATERIALS) shine = shine_of(s.id);
#endif
        vec3 tangent = s.normal;
        if (s.tube && PAPER) s.normal = line_normal(tangent, to_eye);
        else if (s.tube) s.depth = on_tube(s, centre, -s.displacement, s.normal);
        vec3 shaded = vec3(1.0);
        if (SHADING == LIT) {
            shaded = s.tube && PAPER ? lit_line(shine, colour, tangent, to_eye) : lit(shine, colour, s.normal, s.normal, to_eye);
        }
        if (SHADING == COLOUR) shaded = colour;
        if (SHADING == NORMAL) shaded = s.normal;
        if (!PERSPECTIVE || DISTANT) s.depth += view.distance_offset;
        if (SHADING == DEPTH) shaded = vec3(s.depth);
        image = picture_pixel(shaded, COVERAGE ? coverage_of(pixel) : 1.0);
    }
    store_outputs(pixel, image, s.normal, s.depth);
#if defined(STORE_IDS) || defined(LOOKUPS_STORE_IDS)
    imageStore(id_output, pixel, uvec4(s.id));
#endif
}

#endif
