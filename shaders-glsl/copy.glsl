// Copy: the pulled samples of a level to the other pyramid (marroquim2008 §3.5, figure 7b).
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pixel_group.glsl"
#include "lib/pyramid.glsl"
#include "lib/level.glsl"

PYRAMID_TO_READ(3, from)
PYRAMID_TO_WRITE(2, to)

void main() {
    ivec2 pixel = invocation_pixel();
    if (is_within(pass.size, pixel)) store_words_to(pass.to_origin + pixel, words_from(pass.from_origin + pixel));
}

#endif
