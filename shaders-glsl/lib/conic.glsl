// The ellipse that a splat is on the screen, from sums of squares: no inverse, so it is as stable edge-on as face-on (zwicker2004
// §4.3–4.4, restated).

// A disc's image: a Gaussian's centre (px, relative to the disc centre's image), the unit major axis of its variance V and V's
// eigenvalues (px²). What follows is 0 but where lib/fine_conic.glsl knows it: what rounding took from the offset, and how far V's axis is
// turned from the rounded one (rad).
struct Conic {
    vec2 offset;
    vec2 axis;
    vec2 variance;
    vec2 offset_lo;
    float turn;
};

// V by its entries; sqrt_det = √|V|, px².
Conic conic_of_variance(vec2 o, float xx, float xy, float yy, float sqrt_det) {
    // In units of the larger variance, so that squares neither overflow nor vanish.
    float unit = max(max(xx, yy), 1e-37);
    float half_difference = 0.5 * (xx - yy) / unit;
    xy /= unit;
    float radius = length(vec2(half_difference, xy));
    vec2 axis = half_difference >= 0.0 ? vec2(half_difference + radius, xy) : vec2(xy, radius - half_difference);
    axis = radius > 0.0 ? normalize(axis) : vec2(1.0, 0.0);

    // The smaller eigenvalue by the determinant's closed form: as a difference it would be lost on a long thin ellipse.
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
