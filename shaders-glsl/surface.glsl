// Surface: visibility, attribute and normalize tile by tile, in one dispatch and without targets in between (zwicker2004 §6).
#version 450
#pragma variant SUBGROUPS COMPUTE
#extension GL_GOOGLE_include_directive : require
#include "lib/tile_pass.glsl"

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/picture_pixel.glsl"
#include "lib/splat.glsl"
#include "lib/tile.glsl"
#include "lib/tile_visibility.glsl"
#include "lib/tile_coverage.glsl"
#include "lib/tile_attribute.glsl"

void main() {
    load_frame();
    uvec2 low = tile_low();
    find_visible(low);
    if (COVERAGE) find_covered(low);
    sum_attributes(low);
    for (uint r = 0; r < ROWS; r++) {
        uvec2 at = low + lane_pixel(r);
        float alpha = COVERAGE ? bitCount(covered[r]) / 16.0 : 1.0;
        Pixel pixel = normalize_pixel(vec2(at) + 0.5, depths[r] > 0.0, alpha, tile_sums0[r], tile_sums1[r]);
        if (is_on_picture(at)) store_pixel(at.y * uint(frame.viewport.x) + at.x, pixel);
    }
}

#endif
