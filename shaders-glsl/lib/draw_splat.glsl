// A splat as one triangle about its cut-off ellipse. Varyings are flat; fragments evaluate from gl_FragCoord.

#ifdef VERTEX

layout(location = 0) flat out vec4 anchor_offset;
layout(location = 1) flat out vec4 whitening;
layout(location = 2) flat out vec4 plane_epsilon;
layout(location = 3) flat out vec4 plane_lo_disc;
#ifdef SEES_CLIPS
layout(location = 9) flat out uint clip_out;
#endif
layout(location = 11) flat out mat2x4 fine;
#ifdef COVERAGE
layout(location = 10) flat out vec4 solid_whitening;
#endif

// More than the rasterizer's snapping of vertices, at least 1/16 px, could take from an edge.
const float EDGE = 0.125;
// A triangle that reaches further than this (px) is replaced by one over the viewport, whose edges stay exact.
const float LARGEST = 8192.0;

// Places a corner of splat i's footprint of the given variance.
void place_splat(uint i, Splat splat, vec2 variance, int corner) {
    uint clip = clip_number(i);
#ifdef SEES_CLIPS
    clip_out = clip;
#endif
    Ellipse ellipse = ellipse_of(splat, variance, clip);
    anchor_offset = vec4(ellipse.anchor, ellipse.offset);
    whitening = ellipse.whitening;
    fine = ellipse.fine;
    plane_epsilon = vec4(ellipse.plane_hi, splat.epsilon);
    plane_lo_disc = vec4(ellipse.plane_lo, splat.key_disc);
#ifdef COVERAGE
    solid_whitening = solid_of(splat, clip).whitening;
#endif

    // The nearest depth in the ellipse bounds every fragment's, which lets a device reject the triangle early.
    float stretch = stretch_of(splat, variance, ellipse.key_centre);
    float nearest = min(1.0, nearest_of(splat, variance, stretch));

    vec2 minor_axis = vec2(-splat.axis.y, splat.axis.x);
    vec2 reach = stretch * frame.cutoff * sqrt(variance) + EDGE;
    vec2 position;
    if (kind_of(splat) == NOT_DRAWN || nearest <= frame.key_far) {
        position = vec2(0.0); // all corners alike: no fragments
    } else if (reach.x > 0.5 * LARGEST) {
        position = vec2(corner == 1 ? 3.0 : -1.0, corner == 2 ? 3.0 : -1.0);
    } else {
        const vec2 equilateral[3] = vec2[](vec2(0.0, 2.0), vec2(-1.7320508, -1.0), vec2(1.7320508, -1.0));
        vec2 local = equilateral[corner] * reach;
        vec2 pixel = ellipse.anchor + splat.offset + local.x * splat.axis + local.y * minor_axis;
        position = 2.0 * pixel / frame.viewport - 1.0;
    }
    gl_Position = vec4(position, nearest, 1.0);
}

#endif
#ifdef FRAGMENT

layout(location = 0) flat in vec4 anchor_offset;
layout(location = 1) flat in vec4 whitening;
layout(location = 2) flat in vec4 plane_epsilon;
layout(location = 3) flat in vec4 plane_lo_disc;
#ifdef SEES_CLIPS
layout(location = 9) flat in uint clip;
#else
const uint clip = ~0u;
#endif
layout(location = 11) flat in mat2x4 fine;
#ifdef COVERAGE
layout(location = 10) flat in vec4 solid_whitening;
#endif

#ifndef COVERAGE
// The bound given by the vertex stage holds: κ only falls from there. Hidden fragments cover too, so that none may be skipped by it.
layout(depth_less) out float gl_FragDepth;
#endif

// As splat_fragment; where there is no fragment, there is none.
void drawn_fragment(out vec2 m, out float key, out float rank) {
    float key_centre = centre_key(plane_epsilon.xyz, plane_lo_disc.xyz, anchor_offset.zw);
    Ellipse ellipse = Ellipse(
        anchor_offset.xy, anchor_offset.zw, whitening, fine, plane_epsilon.xyz, plane_lo_disc.xyz, key_centre, clip);
    vec2 centre = gl_FragCoord.xy - frame.origin;
    if (!splat_fragment(ellipse, centre, m, key, rank)) discard;
#ifdef COVERAGE
    uvec2 pixel = uvec2(centre);
    ellipse.whitening = solid_whitening;
    cover(pixel.y * uint(frame.viewport.x) + pixel.x, ellipse, centre);
#endif
}

#endif
