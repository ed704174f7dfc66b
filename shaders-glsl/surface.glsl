// Surface: runs visibility, attribute and normalize per tile in one dispatch, without intermediate targets (zwicker2004 §6).
#version 450
#pragma variant SUBGROUPS COMPUTE
#extension GL_GOOGLE_include_directive : require
#include "lib/tile_pass.glsl"

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/picture_pixel.glsl"
#include "lib/splat.glsl"
#include "lib/pixels.glsl"
#include "lib/tile.glsl"
#include "lib/tile_visibility.glsl"
#include "lib/tile_coverage.glsl"
#include "lib/tile_attribute.glsl"

void main() {
    load_frame();
    uvec2 origin = tile_origin();
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        uint index = is_in_viewport(pixel) ? pixel_index(ivec2(pixel)) : 0;
        if (has_depths()) load_depth(r, visibility[index]);
    }
    compute_visibility(origin);
    if (COVERAGE) compute_coverage(origin);
    sum_attributes(origin);
    report_incomplete();
    for (uint r = 0; r < ROWS; r++) {
        uvec2 pixel = origin + lane_pixel(r);
        float alpha = COVERAGE ? bitCount(coverage_masks[r]) / 16.0 : 1.0;
        Pixel result = normalize_pixel(vec2(pixel) + 0.5, depths[r] > 0.0, alpha, tile_sums0[r], tile_sums1[r]);
        if (is_in_viewport(pixel)) store_pixel(ivec2(pixel), result);
    }
}

#endif
