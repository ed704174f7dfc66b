// A splat as one triangle about its cut-off ellipse. Varyings are flat; fragments evaluate from gl_FragCoord.

#ifdef VERTEX

layout(location = 0) flat out vec4 anchor_offset; // the anchor (px) and the ellipse's centre relative to it
layout(location = 1) flat out vec4 whitening;     // rows of the map from px to σ
layout(location = 2) flat out vec4 depth_plane;   // κ at the anchor, its derivatives; .w = the splat's epsilon

// More than the rasterizer's snapping of vertices, at least 1/16 px, could take from an edge.
const float EDGE = 0.125;
// A triangle that reaches further than this (px) is replaced by one over the viewport, whose edges stay exact.
const float LARGEST = 8192.0;

float place_splat(Splat splat, float lowpass, int corner) {
    vec2 variance = splat.variance + lowpass;
    vec2 deviation = sqrt(variance);
    vec2 side_axis = vec2(-splat.axis.y, splat.axis.x);
    vec2 anchor = anchor_of(splat.centre);
    vec2 offset = splat.centre - anchor;
    anchor_offset = vec4(anchor, offset);
    whitening = vec4(splat.axis / deviation.x, side_axis / deviation.y);
    depth_plane = vec4(splat.plane, splat.epsilon);

    // The nearest depth in the ellipse bounds every fragment's, which lets a device reject the triangle early.
    vec2 slope = vec2(dot(splat.plane.yz, splat.axis), dot(splat.plane.yz, side_axis)) * deviation * frame.cutoff;
    float nearest = splat.plane.x + dot(splat.plane.yz, offset) + length(slope);
    nearest = min(1.0, nearest * (1.0 + 1e-6) + 1e-30);

    vec2 reach = frame.cutoff * deviation + EDGE;
    vec2 position;
    if (splat.side == 0.0 || nearest <= frame.key_far) {
        position = vec2(0.0); // all corners alike: no fragments
    } else if (reach.x > 0.5 * LARGEST) {
        position = vec2(corner == 1 ? 3.0 : -1.0, corner == 2 ? 3.0 : -1.0);
    } else {
        const vec2 equilateral[3] = vec2[](vec2(0.0, 2.0), vec2(-1.7320508, -1.0), vec2(1.7320508, -1.0));
        vec2 local = equilateral[corner] * reach;
        vec2 pixel = splat.centre + local.x * splat.axis + local.y * side_axis;
        position = 2.0 * pixel / frame.viewport - 1.0;
    }
    gl_Position = vec4(position, nearest, 1.0);
    return splat.sqrt_det * inversesqrt(variance.x * variance.y);
}

#endif
#ifdef FRAGMENT

layout(location = 0) flat in vec4 anchor_offset;
layout(location = 1) flat in vec4 whitening;
layout(location = 2) flat in vec4 depth_plane;

// The bound given by the vertex stage holds: κ only falls from there.
layout(depth_less) out float gl_FragDepth;

// Squared distance to the splat's centre in σ, and the tangent plane's κ; discards outside the cut-off and the depth range.
float splat_fragment(out float key) {
    vec2 d = gl_FragCoord.xy - anchor_offset.xy;
    vec2 e = d - anchor_offset.zw;
    vec2 u = vec2(dot(whitening.xy, e), dot(whitening.zw, e));
    float m2 = dot(u, u);
    key = depth_plane.x + dot(depth_plane.yz, d);
    if (m2 > frame.cutoff * frame.cutoff || !(key > frame.key_far && key <= 1.0)) discard;
    return m2;
}

#endif
