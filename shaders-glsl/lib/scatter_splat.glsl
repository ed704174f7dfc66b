// The compute rasterizer: an invocation visits the pixels of a splat, row by row. Splats of many pixels, which would hold their
// neighbours up, are left to a second dispatch (LARGE_SPLATS) with a workgroup a splat.
//
// The including pass defines what happens: `scatter_variance(variance)` makes its footprint's variance of V's; `scatter_begin(i,
// splat, variance, nearest, low, high)` says once a splat whether its fragments, in the pixels from low to high and no nearer than
// the κ nearest, are wanted; and `scatter(pixel, centre, m, key, rank)` takes each, m σ from the centre.

layout(local_size_x = 64) in;

#define LIST_ACCESS readonly
#include "lib/large_splats.glsl"

// The first and last pixel of row y that can be within `rim` σ; at least one, whose fragment is tested all the same.
ivec2 row_span(Ellipse ellipse, float rim, int y, ivec2 low, ivec2 high) {
    vec2 x_axis = ellipse.whitening.xz, y_axis = ellipse.whitening.yw;
    float ey = float(y) + 0.5 - ellipse.anchor.y - ellipse.offset.y;
    float inverse = 1.0 / dot(x_axis, x_axis);
    float determinant = x_axis.x * y_axis.y - x_axis.y * y_axis.x;
    float square = inverse * (rim * rim - ey * ey * inverse * determinant * determinant);
    // More than what rounding takes from a splat of this kind's few pixels.
    float half_width = sqrt(max(square, 0.0)) + 0.03125;
    float middle = ellipse.anchor.x + ellipse.offset.x - ey * inverse * dot(x_axis, y_axis) - 0.5;
    vec2 ends = clamp(vec2(ceil(middle - half_width), floor(middle + half_width)), vec2(low.x), vec2(high.x));
    return ivec2(ends.x, max(ends.x, ends.y));
}

void scatter_rows(Ellipse ellipse, float rim, ivec2 low, ivec2 high) {
    vec2 m;
    float key, rank;
    int y = low.y;
    ivec2 span = row_span(ellipse, rim, y, low, high);
    // One loop over all rows keeps invocations with rows of other lengths in step.
    while (y <= high.y) {
        ivec2 pixel = ivec2(span.x, y);
        vec2 centre = vec2(pixel) + 0.5;
        if (splat_fragment(ellipse, centre, m, key, rank)) scatter(pixel_index(pixel), centre, m, key, rank);
        span.x++;
        if (span.x > span.y) span = row_span(ellipse, rim, ++y, low, high);
    }
}

void scatter_box(Ellipse ellipse, ivec2 low, ivec2 high) {
    vec2 m;
    float key, rank;
    uint width = uint(high.x - low.x + 1);
    uint area = width * uint(high.y - low.y + 1);
    for (uint k = gl_LocalInvocationIndex; k < area; k += gl_WorkGroupSize.x) {
        ivec2 pixel = low + ivec2(k % width, k / width);
        vec2 centre = vec2(pixel) + 0.5;
        if (splat_fragment(ellipse, centre, m, key, rank)) scatter(pixel_index(pixel), centre, m, key, rank);
    }
}

void scatter_splat(uint i) {
    Splat splat = splat_of(i);
    if (kind_of(splat) != (LARGE_SPLATS ? LARGE : SMALL)) return;
    vec2 variance = scatter_variance(variance_of(splat));
    Ellipse ellipse = ellipse_of(splat, variance, screen_clip_number(i));
    float stretch = stretch_of(splat, variance, ellipse.key_centre);
    vec2 reach = stretch * reach_of(splat.axis, variance);
    vec2 first = anchor_of(splat) + splat.offset - 0.5;
    ivec2 low = ivec2(max(ceil(first - reach), vec2(0.0)));
    ivec2 high = ivec2(min(floor(first + reach), frame.viewport - 1.0));
    if (any(greaterThan(low, high))) return;
    if (!scatter_begin(i, splat, variance, nearest_of(splat, variance, stretch), low, high)) return;
    if (LARGE_SPLATS) scatter_box(ellipse, low, high);
    else scatter_rows(ellipse, stretch * frame.cutoff, low, high);
}

void scatter_splats() {
    if (LARGE_SPLATS) {
        uint count = large_splats[instance_number()];
        for (uint k = gl_WorkGroupID.x; k < count; k += gl_NumWorkGroups.x) scatter_splat(large_splats[list_start() + k]);
    } else if (gl_GlobalInvocationID.x < window.count) {
        scatter_splat(gl_GlobalInvocationID.x);
    }
}
