// Ellipse of lib/conic.glsl from sums of two floats, for kernels with a steep rim: floats rotate the ellipse by 10⁻⁷, which moves the rim
// at the tips of an edge-on ellipse by that times its slenderness.

// Gradient of a pixel coordinate, or w, on the disc, per radius: a world vector, and its products with the normal and the major axis.
struct Gradient {
    vec3 hi, lo;
    vec2 normal;
    vec2 major;
};

// Metric of a disc: sums over its semi-axes e of (a·e)(b·e), for world vectors a and b, computed from n and not from the axes.
struct Metric {
    vec2 per_normal; // 1 / n·n: in floats n is not exactly a unit vector
    vec2 tilt;       // n·major / n·n
    vec2 per_major;  // added by the longer axis to the circle of the shorter one's radius
    vec2 aspect2;
};

Metric metric_of(Disc disc) {
    vec2 one = vec2(1.0, 0.0);
    Metric metric;
    metric.per_normal = divide(one, dot_double(disc.normal, vec3(0.0), disc.normal, vec3(0.0)));
    metric.tilt = metric.per_major = vec2(0.0);
    metric.aspect2 = one;
    if (!ELLIPSES) return metric;
    vec2 across = dot_double(disc.normal, vec3(0.0), disc.major, vec3(0.0));
    metric.tilt = multiply(across, metric.per_normal);
    metric.aspect2 = two_product(disc.aspect, disc.aspect);
    vec2 length2 = add(dot_double(disc.major, vec3(0.0), disc.major, vec3(0.0)), -multiply(across, metric.tilt));
    metric.per_major = divide(add(one, -metric.aspect2), length2);
    return metric;
}

// Gradient of row i of the projection at the pixel coordinate `centre`, times `size`.
Gradient gradient_of(int i, vec2 centre, vec2 size, Disc disc, Metric metric) {
    Gradient gradient;
    for (int k = 0; k < 3; k++) {
        vec2 w = vec2(view.rows_hi[2][k], view.rows_lo[2][k]);
        vec2 entry = add(vec2(view.rows_hi[i][k], view.rows_lo[i][k]), -multiply(w, centre));
        entry = multiply(entry, size);
        gradient.hi[k] = entry.x;
        gradient.lo[k] = entry.y;
    }
    gradient.normal = dot_double(gradient.hi, gradient.lo, disc.normal, vec3(0.0));
    gradient.major = vec2(0.0);
    if (!ELLIPSES) return gradient;
    gradient.major = dot_double(gradient.hi, gradient.lo, disc.major, vec3(0.0));
    gradient.major = add(gradient.major, -multiply(metric.tilt, gradient.normal));
    return gradient;
}

// Inner product of a and b in the metric.
vec2 along_disc(Metric metric, Gradient a, Gradient b) {
    vec2 product = dot_double(a.hi, a.lo, b.hi, b.lo);
    vec2 circle = add(product, -multiply(multiply(a.normal, b.normal), metric.per_normal));
    if (!ELLIPSES) return circle;
    return add(multiply(circle, metric.aspect2), multiply(multiply(a.major, b.major), metric.per_major));
}

// Largest residual, rad. Rounding rotates a near-circle by more, without effect.
const float MOST_RESIDUAL = 1e-4;

// Angle from the conic's axis to the variance's: its covariance with the minor axis, over the difference of the eigenvalues.
float axis_residual_of(Conic conic, vec2 xx, vec2 xy, vec2 yy) {
    vec2 a = conic.axis;
    vec2 diagonal = multiply(add(yy, -xx), two_product(a.x, a.y));
    vec2 other = multiply(xy, add(two_product(a.x, a.x), -two_product(a.y, a.y)));
    float difference = conic.variance.x - conic.variance.y;
    return difference > 0.0 ? clamp(add(diagonal, other).x / difference, -MOST_RESIDUAL, MOST_RESIDUAL) : 0.0;
}

// Computes conic_of of the same disc; o, q and V are restated in the metric, with w = 1.
Conic fine_conic(Disc disc, float sqrt_det) {
    Metric metric = metric_of(disc);
    vec2 size = divide(vec2(disc.radius, 0.0), scale(disc.w, frame.cutoff));
    Gradient x = gradient_of(0, divide(disc.x, disc.w), size, disc, metric);
    Gradient y = gradient_of(1, divide(disc.y, disc.w), size, disc, metric);
    vec2 xx = along_disc(metric, x, x), xy = along_disc(metric, x, y), yy = along_disc(metric, y, y);
    vec2 ox = vec2(0.0), oy = vec2(0.0);
    if (FOOTPRINT == CONIC && PERSPECTIVE) {
        Gradient w = gradient_of(2, vec2(0.0), scale(size, frame.cutoff), disc, metric);
        vec2 q = add(vec2(1.0, 0.0), -along_disc(metric, w, w));
        // −o / F first, then o.
        ox = divide(along_disc(metric, x, w), q);
        oy = divide(along_disc(metric, y, w), q);
        xx = add(divide(xx, q), multiply(ox, ox));
        xy = add(divide(xy, q), multiply(ox, oy));
        yy = add(divide(yy, q), multiply(oy, oy));
        ox = scale(ox, -frame.cutoff);
        oy = scale(oy, -frame.cutoff);
    }
    Conic conic = conic_of_variance(vec2(ox.x, oy.x), xx.x, xy.x, yy.x, sqrt_det);
    conic.offset_lo = vec2(ox.y, oy.y);
    conic.axis_residual = axis_residual_of(conic, xx, xy, yy);
    return conic;
}
