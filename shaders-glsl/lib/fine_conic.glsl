// The ellipse of lib/conic.glsl from sums of two floats. A kernel with a steep rim wants it: floats turn the ellipse by 10⁻⁷, which at the
// tips of one that is seen edge-on moves the rim by as many times its slenderness.

// What a pixel coordinate, or w, changes by along the disc, in units of the radius: a vector of the world, and its products with the
// normal and with the major axis.
struct Gradient {
    vec3 hi, lo;
    vec2 normal;
    vec2 major;
};

// The metric of a disc: sums over its semi-axes e of (a·e)(b·e), for vectors a and b of the world, from n and not from the axes.
struct Metric {
    vec2 per_normal; // 1 / n·n: floats make n no unit vector
    vec2 tilt;       // n·major / n·n
    vec2 per_major;  // what the longer axis adds to a circle's, whose radius is the shorter
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

// Of row i of the projection, at the pixel coordinate `centre`, per `size`.
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

// The metric's product of a and b.
vec2 along_disc(Metric metric, Gradient a, Gradient b) {
    vec2 all = dot_double(a.hi, a.lo, b.hi, b.lo);
    vec2 circle = add(all, -multiply(multiply(a.normal, b.normal), metric.per_normal));
    if (!ELLIPSES) return circle;
    return add(multiply(circle, metric.aspect2), multiply(multiply(a.major, b.major), metric.per_major));
}

// Largest turn, rad. Rounding turns a near-circle by more, but does not show there.
const float MOST_TURN = 1e-4;

// How far the axis of the variance is turned from the conic's: its covariance with the minor axis, over the difference of the eigenvalues.
float turn_of(Conic conic, vec2 xx, vec2 xy, vec2 yy) {
    vec2 a = conic.axis;
    vec2 diagonal = multiply(add(yy, -xx), two_product(a.x, a.y));
    vec2 other = multiply(xy, add(two_product(a.x, a.x), -two_product(a.y, a.y)));
    float difference = conic.variance.x - conic.variance.y;
    return difference > 0.0 ? clamp(add(diagonal, other).x / difference, -MOST_TURN, MOST_TURN) : 0.0;
}

// As conic_of of the same disc; o, q and V are restated in the metric, with w = 1.
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
        // −o / F, and o at last.
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
    conic.turn = turn_of(conic, xx, xy, yy);
    return conic;
}
