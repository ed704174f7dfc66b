// Splats on the raster path: one triangle around each cut-off ellipse. Varyings are flat; fragments evaluate them at gl_FragCoord.

#ifdef VERTEX

layout(location = 0) flat out vec4 anchor_offset;
layout(location = 1) flat out vec4 whitening;
layout(location = 2) flat out vec4 plane_epsilon;
layout(location = 3) flat out vec4 plane_lo_disc;
#ifdef READS_CLIPS
layout(location = 9) flat out uint clip_out;
#endif
layout(location = 11) flat out mat2x4 fine;
layout(location = 13) flat out vec2 least_keys; // of fragments and of samples
#ifdef COVERAGE
layout(location = 10) flat out vec4 solid_whitening;
#endif

// Margin of a triangle's edges, px: more than rasterizers, which snap vertices to a grid of 1/16 px or finer, can move them.
const float EDGE_MARGIN = 0.125;
// Largest extent of a triangle, px: a larger one is replaced by a triangle over the viewport, whose edges stay exact.
const float LARGEST_TRIANGLE = 8192.0;

// Corner, px, of a triangle around the part inside the viewport of the ellipse with these semi-axes, px. A triangle inside the viewport is
// not clipped; CPU rasterizers process all triangles of a draw differently if one is.
vec2 corner_about(vec2 centre, vec2 axis, vec2 reach, int corner) {
    vec2 major = reach.x * axis, minor = reach.y * vec2(-axis.y, axis.x);
    vec2 corners[3] = vec2[](centre + 2.0 * minor, centre - 1.7320508 * major - minor, centre + 1.7320508 * major - minor);
    vec2 low = min(min(corners[0], corners[1]), corners[2]), high = max(max(corners[0], corners[1]), corners[2]);
    if (all(greaterThanEqual(low, vec2(0.0))) && all(lessThanEqual(high, frame.viewport))) return corners[corner];
    // Right triangle around the bounding box inside the viewport, of twice its width and height.
    vec2 reach_of_box = sqrt(major * major + minor * minor);
    low = clamp(centre - reach_of_box, vec2(0.0), frame.viewport);
    high = clamp(centre + reach_of_box, vec2(0.0), frame.viewport);
    vec2 size = high - low;
    bvec2 right_way = lessThanEqual(low + 2.0 * size, frame.viewport);
    vec2 far = mix(high - 2.0 * size, low + 2.0 * size, right_way), near = mix(high, low, right_way);
    return vec2(corner == 1 ? far.x : near.x, corner == 2 ? far.y : near.y);
}

// Writes a vertex of the triangle of splat i with the given variance.
void write_splat_vertex(uint i, Splat splat, vec2 variance, int corner) {
    uint clip = screen_clip_index(i);
#ifdef READS_CLIPS
    clip_out = clip;
#endif
    Ellipse ellipse = ellipse_of(splat, variance, clip);
    anchor_offset = vec4(ellipse.anchor, ellipse.offset);
    whitening = ellipse.whitening;
    fine = ellipse.fine;
    least_keys = vec2(ellipse.least_key, least_key(splat));
    // Fragment shaders read distances in the world's unit.
    if (INSTANCED && has_linear_depth()) scale_plane(view.scale, ellipse.plane_hi, ellipse.plane_lo);
    plane_epsilon = vec4(ellipse.plane_hi, splat.epsilon);
    plane_lo_disc = vec4(ellipse.plane_lo, splat.key_disc);
#ifdef COVERAGE
    solid_whitening = solid_ellipse(splat, clip).whitening;
#endif

    // The nearest depth in the ellipse bounds every fragment's: conservative depth for early tests.
    float stretch = stretch_of(splat, variance, ellipse.key_centre);
    float nearest = min(1.0, nearest_of(splat, variance, stretch));

    vec2 reach = stretch * frame.cutoff * sqrt(variance) + EDGE_MARGIN;
    vec2 position;
    if (!is_drawn(splat) || nearest <= frame.key_far) {
        position = vec2(0.0); // degenerate: no fragments
    } else if (reach.x > 0.5 * LARGEST_TRIANGLE) {
        position = vec2(corner == 1 ? 3.0 : -1.0, corner == 2 ? 3.0 : -1.0);
    } else {
        vec2 pixel = corner_about(ellipse.anchor + splat.offset, splat.axis, reach, corner);
        position = 2.0 * pixel / frame.viewport - 1.0;
    }
    gl_Position = vec4(position, least_tested(nearest), 1.0);
}

#endif
#ifdef FRAGMENT

layout(location = 0) flat in vec4 anchor_offset;
layout(location = 1) flat in vec4 whitening;
layout(location = 2) flat in vec4 plane_epsilon;
layout(location = 3) flat in vec4 plane_lo_disc;
#ifdef READS_CLIPS
layout(location = 9) flat in uint clip;
#else
const uint clip = ~0u;
#endif
layout(location = 11) flat in mat2x4 fine;
layout(location = 13) flat in vec2 least_keys;
#ifdef COVERAGE
layout(location = 10) flat in vec4 solid_whitening;
#endif

#ifndef COVERAGE
// The vertex stage bounds κ from above. With COVERAGE, hidden fragments cover samples too, so no early test may discard them.
layout(depth_less) out float gl_FragDepth;
#endif

#ifdef COVERAGE
// Solid ellipse of the fragment's splat, once evaluate_fragment has run.
Ellipse solid;

// Place of the fragment's pixel in buffers.
uint fragment_index() {
    uvec2 pixel = uvec2(gl_FragCoord.xy - frame.origin);
    return pixel.y * uint(frame.viewport.x) + pixel.x;
}

// Mask of the samples that the splat covers at the fragment's pixel.
uint fragment_mask() {
    return coverage_mask(solid, least_keys.y, gl_FragCoord.xy - frame.origin);
}

// Adds the samples that the splat covers at the fragment's pixel.
void add_fragment_coverage() {
    uint index = fragment_index(), covered = coverage[index];
    if (covered == ALL_SAMPLES) return;
    uint mask = fragment_mask();
    if ((mask & ~covered) != 0) atomicOr(coverage[index], mask);
}
#endif

// Kernel coordinates of the fragment's pixel by the affine map, σ: without the perspective of kernels in the tangent plane.
vec2 flat_kernel_coordinates() {
    vec2 e = gl_FragCoord.xy - frame.origin - anchor_offset.xy - anchor_offset.zw;
    return vec2(dot(whitening.xy, e), dot(whitening.zw, e));
}

// Evaluates splat_fragment; discards the fragment if it is outside.
void evaluate_fragment(out vec2 m, out float key, out float rank) {
    float key_centre = centre_key(plane_epsilon.xyz, plane_lo_disc.xyz, anchor_offset.zw);
    Ellipse ellipse = Ellipse(
        anchor_offset.xy, anchor_offset.zw, whitening, fine, plane_epsilon.xyz, plane_lo_disc.xyz, key_centre, least_keys.x,
        plane_lo_disc.w, clip);
    vec2 centre = gl_FragCoord.xy - frame.origin;
    if (!splat_fragment(ellipse, centre, m, key, rank)) discard;
#ifdef COVERAGE
    ellipse.whitening = solid_whitening;
    solid = ellipse;
#endif
}

#endif
