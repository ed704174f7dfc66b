// The splat of a disc by the dual conic: no inverse, so it is as stable edge-on as face-on (zwicker2004 §4.3–4.4, restated).

// A disc's image: a Gaussian's centre (px, relative to the disc centre's image), the unit major axis of its variance V and V's
// eigenvalues (px²).
struct Conic {
    vec2 offset;
    vec2 axis;
    vec2 variance;
};

// S, T: homogeneous pixels (x, y, w) of the 1-σ axes; centre: px; q = (w / F)² − g·g > 0; sqrt_det = √|V|.
Conic dual_conic(vec2 centre, vec3 S, vec3 T, float q, float cutoff, float sqrt_det) {
    vec2 g = vec2(S.z, T.z);
    // Rows of D are the x and y rows of the derivative of the projection, times w.
    vec2 Dx = vec2(S.x, T.x) - centre.x * g;
    vec2 Dy = vec2(S.y, T.y) - centre.y * g;
    vec2 o = -vec2(dot(Dx, g), dot(Dy, g)) / q;

    float scale = 1.0 / (cutoff * cutoff);
    float xx = scale * (dot(Dx, Dx) / q + o.x * o.x);
    float xy = scale * (dot(Dx, Dy) / q + o.x * o.y);
    float yy = scale * (dot(Dy, Dy) / q + o.y * o.y);
    // In units of the larger variance, so that squares neither overflow nor vanish.
    float unit = max(max(xx, yy), 1e-37);
    float half_difference = 0.5 * (xx - yy) / unit;
    xy /= unit;
    float radius = length(vec2(half_difference, xy));
    vec2 axis = half_difference >= 0.0 ? vec2(half_difference + radius, xy) : vec2(xy, radius - half_difference);
    axis = radius > 0.0 ? normalize(axis) : vec2(1.0, 0.0);

    // The smaller eigenvalue by the determinant's closed form: as a difference it would be lost on a long thin ellipse.
    float major = 0.5 * (xx + yy) + radius * unit;
    return Conic(o, axis, vec2(major, sqrt_det * (sqrt_det / major)));
}
