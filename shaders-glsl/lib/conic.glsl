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
    float half_difference = 0.5 * (xx - yy);
    float radius = length(vec2(half_difference, xy));
    vec2 axis = half_difference >= 0.0 ? vec2(half_difference + radius, xy) : vec2(xy, radius - half_difference);
    axis = radius > 0.0 ? normalize(axis) : vec2(1.0, 0.0);

    // V's entries carry an error relative to the larger eigenvalue, which would tilt a long thin ellipse: form them again in the
    // frame of the axis just found, where the off-diagonal is small, and turn by what is left of it.
    vec2 D_major = axis.x * Dx + axis.y * Dy;
    vec2 D_minor = axis.x * Dy - axis.y * Dx;
    float o_major = dot(axis, o);
    float o_minor = axis.x * o.y - axis.y * o.x;
    float major = scale * (dot(D_major, D_major) / q + o_major * o_major);
    float minor = scale * (dot(D_minor, D_minor) / q + o_minor * o_minor);
    float off = scale * (dot(D_major, D_minor) / q + o_major * o_minor);
    if (major - minor > 1e-2 * major) {
        float turn = off / (major - minor);
        axis = normalize(axis + turn * vec2(-axis.y, axis.x));
        major += turn * off;
    }
    return Conic(o, axis, vec2(major, sqrt_det * sqrt_det / major));
}
