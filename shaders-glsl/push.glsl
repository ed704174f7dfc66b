// Push: a pixel of the finer level from the coarser pixels around it and from its neighbours (marroquim2008 §3.3).
#version 450
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_samplerless_texture_functions : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pixel_group.glsl"
#include "lib/pyramid.glsl"
#include "lib/level.glsl"
#include "lib/camera_rays.glsl"

PYRAMID_TO_READ(3, from)
PYRAMID_TO_READ(2, final)
PYRAMID_TO_WRITE(2, to)

#include "lib/reconstruction.glsl"
#include "lib/filled_tiles.glsl"

void main() {
    ivec2 pixel = pass.level < LISTED_LEVELS ? LISTED_PIXEL(filled, pass.level) : invocation_pixel();
    if (is_within(pass.size, pixel)) store_to(pass.to_origin + pixel, reconstructed(pixel));
}

#endif
