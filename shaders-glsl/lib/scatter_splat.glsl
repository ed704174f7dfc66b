// The compute rasterizer: an invocation visits the pixels of a splat's box. Splats of many pixels, which would hold their neighbours
// up, are left to a second dispatch (LARGE_SPLATS) with a workgroup a splat.
//
// The including pass defines what happens: `scatter_begin(i, splat, variance)` once a splat and `scatter(pixel, m2, key)` at each
// of its fragments.

layout(local_size_x = 64) in;

layout(constant_id = 8) const bool LARGE_SPLATS = false;

layout(set = 0, binding = 7, std430) readonly buffer LargeSplats { uint large_count; uint large_padding[63]; uint large[]; };

layout(push_constant) uniform Window { uint count; } window;

void scatter_box(uint i, float lowpass, uint first, uint step) {
    Splat splat = splats[i];
    if (splat.side == 0.0 || !LARGE_SPLATS && abs(splat.side) == LARGE) return;
    vec2 variance = splat.variance + lowpass;
    vec2 reach = reach_of(splat.axis, variance);
    ivec2 low = ivec2(max(ceil(splat.centre - reach - 0.5), vec2(0.0)));
    ivec2 high = ivec2(min(floor(splat.centre + reach - 0.5), frame.viewport - 1.0));
    if (any(greaterThan(low, high))) return;
    uint width = uint(high.x - low.x + 1);
    uint area = width * uint(high.y - low.y + 1);
    Ellipse ellipse = ellipse_of(splat, variance);
    scatter_begin(i, splat, variance);
    for (uint k = first; k < area; k += step) {
        ivec2 pixel = low + ivec2(k % width, k / width);
        float m2, key;
        if (splat_fragment(ellipse, vec2(pixel) + 0.5, m2, key)) scatter(pixel_index(pixel), m2, key);
    }
}

void scatter_splats(float lowpass) {
    if (LARGE_SPLATS) {
        for (uint k = gl_WorkGroupID.x; k < large_count; k += gl_NumWorkGroups.x)
            scatter_box(large[k], lowpass, gl_LocalInvocationIndex, gl_WorkGroupSize.x);
    } else if (gl_GlobalInvocationID.x < window.count) {
        scatter_box(gl_GlobalInvocationID.x, lowpass, 0, 1);
    }
}
