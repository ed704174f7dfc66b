// A splat: what the footprint pass makes of a surfel, and what visibility and attribute draw.

struct Splat {
    vec2 centre;    // px
    vec2 axis;      // unit major axis of the variance V
    vec2 variance;  // V's eigenvalues, px²
    float sqrt_det; // √|V|, px²
    float epsilon;  // perspective: 1 / (1 + ε/z), scales κ; orthographic: ε as a difference of κ
    vec3 plane;     // κ of the tangent plane at the anchor, and its derivatives along x and y, 1/px
    float side;     // +1 the normal faces the eye, −1 it faces away, 0 not drawn
};

layout(set = 0, binding = 1, std430) SPLAT_ACCESS buffer Splats { Splat splats[]; };

// The pixel centre that a splat's κ is given at: the nearest to its centre, so that the plane is evaluated close by.
vec2 anchor_of(vec2 centre) {
    return clamp(floor(centre) + 0.5, vec2(0.5), frame.viewport - 0.5);
}
