// Ellipse of a splat on the screen, from sums of squares: without a matrix inverse it is as stable edge-on as face-on (zwicker2004
// §4.3–4.4, restated).

// Projection of a disc: centre of the Gaussian (px, relative to the projected disc centre), unit major axis of its variance V and V's
// eigenvalues (px²). Only lib/fine_conic.glsl sets the rest: the rounding error of the offset, and the angle from the rounded axis to V's
// (rad).
struct Conic {
    vec2 offset;
    vec2 axis;
    vec2 variance;
    vec2 offset_lo;
    float axis_residual;
};

// Conic of a variance V; sqrt_det = √|V|, px².
Conic conic_of_variance(vec2 o, float xx, float xy, float yy, float sqrt_det) {
    // Scaled by the larger variance, so that squares neither overflow nor underflow.
    float unit = max(max(xx, yy), 1e-37);
    float half_difference = 0.5 * (xx - yy) / unit;
    xy /= unit;
    float radius = length(vec2(half_difference, xy));
    vec2 axis = half_difference >= 0.0 ? vec2(half_difference + radius, xy) : vec2(xy, radius - half_difference);
    axis = radius > 0.0 ? normalize(axis) : vec2(1.0, 0.0);

    // The smaller eigenvalue by the determinant's closed form: a difference would cancel for a thin ellipse.
    float major = 0.5 * (xx + yy) + radius * unit;
    return Conic(o, axis, vec2(major, sqrt_det * (sqrt_det / major)), vec2(0.0), 0.0);
}

// V = (Dx, Dy)ᵀ(Dx, Dy) / (q F²) + o oᵀ / F².
Conic conic_of(vec3 Dx, vec3 Dy, vec2 o, float q, float cutoff, float sqrt_det) {
    float scale = 1.0 / (cutoff * cutoff);
    float xx = scale * (dot(Dx, Dx) / q + o.x * o.x);
    float xy = scale * (dot(Dx, Dy) / q + o.x * o.y);
    float yy = scale * (dot(Dy, Dy) / q + o.y * o.y);
    return conic_of_variance(o, xx, xy, yy, sqrt_det);
}
