// A splat: what the footprint pass makes of a surfel, and what visibility and attribute draw.

struct Splat {
    vec2 centre;    // px
    vec2 axis;      // unit major axis of the variance V
    vec2 variance;  // V's eigenvalues, px²
    float sqrt_det; // √|V|, px²
    float epsilon;  // perspective: 1 / (1 + ε/z), scales κ; orthographic: ε as a difference of κ
    vec3 plane;     // κ of the tangent plane at the anchor, and its derivatives along x and y, 1/px
    float side;     // > 0 the normal faces the eye, < 0 it faces away, 0 not drawn; ±LARGE for splats of many pixels
};

const float LARGE = 2.0;

layout(set = 0, binding = 1, std430) SPLAT_ACCESS buffer Splats { Splat splats[]; };

// The pixel centre that a splat's κ is given at: the nearest to its centre, so that the plane is evaluated close by.
vec2 anchor_of(vec2 centre) {
    return clamp(floor(centre) + 0.5, vec2(0.5), frame.viewport - 0.5);
}

// Half the width and height, px, of the cut-off ellipse of a variance that is given by its major axis and eigenvalues.
vec2 reach_of(vec2 axis, vec2 variance) {
    vec2 axis2 = axis * axis;
    return frame.cutoff * sqrt(vec2(dot(axis2, variance), dot(axis2.yx, variance)));
}

// What a fragment needs of a splat.
struct Ellipse {
    vec2 anchor;
    vec2 offset;    // the centre relative to the anchor, px
    vec4 whitening; // rows of the map from px to σ
    vec3 plane;
};

Ellipse ellipse_of(Splat splat, vec2 variance) {
    vec2 inverse = inversesqrt(variance);
    vec2 anchor = anchor_of(splat.centre);
    vec4 whitening = vec4(splat.axis * inverse.x, vec2(-splat.axis.y, splat.axis.x) * inverse.y);
    return Ellipse(anchor, splat.centre - anchor, whitening, splat.plane);
}

// Whether the splat has a fragment at a pixel centre: it is within the cut-off, and the tangent plane within the depth range.
// m2: squared distance to the centre in σ; key: the plane's κ.
bool splat_fragment(Ellipse ellipse, vec2 pixel, out float m2, out float key) {
    vec2 d = pixel - ellipse.anchor;
    vec2 e = d - ellipse.offset;
    vec2 u = vec2(dot(ellipse.whitening.xy, e), dot(ellipse.whitening.zw, e));
    m2 = dot(u, u);
    key = ellipse.plane.x + dot(ellipse.plane.yz, d);
    return m2 <= frame.cutoff * frame.cutoff && key > frame.key_far && key <= 1.0;
}

// κ moved away from the eye along the ray by the splat's ε, which divides it by 1 + ε/z. Never 0: that means nothing is there.
float behind(float key, float epsilon) {
    return PERSPECTIVE ? key * epsilon : max(key - epsilon, 1e-6);
}
