// Projection of a disc by kind of footprint: an ellipse on the screen and a plane through the centre.

#include "lib/conic.glsl"
#include "lib/flat_pixel.glsl"

// A disc in front of the eye; all vectors world space.
struct Disc {
    vec3 hi, lo;  // centre relative to the eye
    vec2 w, x, y; // its homogeneous pixel; w is the distance along the viewing direction, 1 for parallel rays
    vec3 normal;
    vec2 h;       // of its plane n·x = h
    vec2 facing;  // above 0 where the normal points away from the eye
    float radius; // longer semi-axis
    float aspect; // shorter semi-axis / longer
    mat2x3 axes;  // directions of the semi-axes, the second of length `aspect`
    vec3 major;   // of an ellipse: the stored first axis, unit and orthogonal to the normal up to rounding
    bool billboard;
};

#include "lib/fine_conic.glsl"

// A splat before the low-pass filter.
struct Image {
    Conic conic;
    float sqrt_det; // √|V|, px²
    float lean;     // depth of the centre less that of the disc's nearest point: w in perspective, else distance
    vec2 slope;     // slope of the plane if it is not the tangent plane: of distance (has_linear_depth) or κ, per px
};

// Least cosine of a sprite's foreshortening. Flatter sprites leave holes: the angle between ray and axis is neglected.
const float LEAST_FORESHORTENING = 0.1;

// Homogeneous pixel of a world vector.
vec3 to_pixel(vec3 v) {
    return vec3(dot(view.rows_hi[0].xyz, v), dot(view.rows_hi[1].xyz, v), dot(view.rows_hi[2].xyz, v));
}

// Clearance of the disc from the eye plane: above 0 if all of the disc is in front. S, T: homogeneous pixels of the 1-σ axes.
float clearance(Disc disc, vec3 S, vec3 T) {
    float g = length(vec2(S.z, T.z));
    return (disc.w.x / frame.cutoff - g) * (disc.w.x / frame.cutoff + g);
}

// Least relative difference of the variances for which a parallelogram's sides follow the ellipse's axes; below it, rounding would rotate
// them, and they follow the screen's. So do those of billboards, whose ellipses are nearly circles everywhere.
const float LEAST_ANISOTROPY = 1e-4;

void align_sides(Disc disc, inout Conic conic) {
    bool circle = disc.billboard || conic.variance.x - conic.variance.y <= LEAST_ANISOTROPY * conic.variance.x;
    if (FOOTPRINT != PARALLELOGRAM || !circle) return;
    conic.axis = vec2(1.0, 0.0);
    conic.axis_residual = 0.0;
}

// Image of a disc: the projection of its rim (zwicker2004 §4.4), or the affine approximation at its centre (ren2002 §3).
Image image_of_disc(Disc disc, float sigma, vec3 S, vec3 T) {
    vec2 g = vec2(S.z, T.z);
    // Rows of D are the x and y rows of the derivative of the projection, times w.
    vec2 centre = vec2(disc.x.x, disc.y.x) / disc.w.x;
    vec2 Dx = vec2(S.x, T.x) - centre.x * g;
    vec2 Dy = vec2(S.y, T.y) - centre.y * g;
    float w = disc.w.x / frame.cutoff;
    float q = FOOTPRINT == CONIC ? clearance(disc, S, T) : w * w;
    vec2 o = FOOTPRINT == CONIC ? -vec2(dot(Dx, g), dot(Dy, g)) / q : vec2(0.0);

    float root = frame.cutoff * sqrt(q);
    float sqrt_det = view.jacobian * disc.aspect * (sigma / root) * (sigma / root) * abs(disc.facing.x) / root;
    float lean = frame.cutoff * (PERSPECTIVE ? length(g) : sigma * length(view.forward_hi.xyz * disc.axes));
    Conic conic = CONFETTI ? fine_conic(disc, sqrt_det)
                           : conic_of(vec3(Dx, 0.0), vec3(Dy, 0.0), o, q, frame.cutoff, sqrt_det);
    align_sides(disc, conic);
    return Image(conic, sqrt_det, lean, vec2(0.0));
}

// Component of a vector parallel to the image plane.
vec3 flattened(vec3 v) {
    return v - dot(v, view.forward_hi.xyz) * view.forward_hi.xyz;
}

// Projected size of a unit length along y at distance 1, px: η.
float focal_length() {
    return length(view.flat_rows[1].xyz);
}

// Image of a sprite: parallel projection of the disc at its centre's scale, with at least LEAST_FORESHORTENING (botsch2003 §3.1–3.3).
Image image_of_sprite(Disc disc, float sigma) {
    float across = dot(disc.normal, view.forward_hi.xyz);
    vec3 along = flattened(disc.normal);
    // √(1 − cosine²) would cancel for a sprite that faces the image plane.
    float sine = min(length(along), sqrt(1.0 - LEAST_FORESHORTENING * LEAST_FORESHORTENING));
    vec3 lean = dot(along, along) > 0.0 ? normalize(along) : vec3(0.0);
    float cosine = max(abs(across), LEAST_FORESHORTENING);

    float whole = 1.0;
    if (FOOTPRINT == WHOLE_SPRITE) {
        float width = 2.0 * disc.radius * focal_length() / disc.w.x;
        whole = max(floor(width + 0.5), 1.0) / width;
    }
    // Per unit of `size`: squares of scene lengths and fourth powers of px may overflow or underflow.
    vec2 s = flat_pixel(disc.axes[0]);
    vec2 t = flat_pixel(disc.axes[1]);
    // Added variance along the projected normal, for the bound. A difference of squares would not be 0 without the bound: a fused
    // multiply-add rounds one square only, and the root of a negative number is NaN.
    vec2 extra = disc.aspect * sqrt((cosine - abs(across)) * (cosine + abs(across))) * flat_pixel(lean);
    // |V| is the sum of the squares of all 2×2 minors (Cauchy and Binet); the first is known in closed form.
    vec2 minors = vec2(s.x, t.x) * extra.y - vec2(s.y, t.y) * extra.x;
    float first = view.jacobian * disc.aspect * abs(across), largest = max(first, max(abs(minors.x), abs(minors.y)));
    // From far away, squares of minors overflow.
    float area = largest > 0.0 ? largest * length(vec3(first, minors) / largest) : 0.0;
    float size = sigma / disc.w.x * whole;
    float sqrt_det = size * size * area;
    vec3 Dx = size * vec3(s.x, t.x, extra.x);
    vec3 Dy = size * vec3(s.y, t.y, extra.y);
    Conic conic = conic_of(Dx, Dy, vec2(0.0), 1.0 / (frame.cutoff * frame.cutoff), frame.cutoff, sqrt_det);

    // Without depth correction all of the sprite is at its centre's depth.
    if (FOOTPRINT == FLAT_SPRITE) return Image(conic, sqrt_det, 0.0, vec2(0.0));
    vec3 tilt = (across < 0.0 ? -1.0 : 1.0) * sine / (cosine * whole) * lean;
    vec2 slope = vec2(dot(tilt, view.ray_hi[0].xyz), dot(tilt, view.ray_hi[1].xyz));
    if (PERSPECTIVE) slope *= -disc.w.x / view.near;
    return Image(conic, sqrt_det, disc.radius * sine, slope);
}

// Image of a square that faces the image plane (botsch2003 §3.1).
Image image_of_square(Disc disc, float sigma) {
    vec2 size = sigma / disc.w.x * vec2(length(view.flat_rows[0].xyz), focal_length());
    bool wide = size.x >= size.y;
    vec2 variance = wide ? size * size : size.yx * size.yx;
    vec2 axis = wide ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
    return Image(Conic(vec2(0.0), axis, variance, vec2(0.0), 0.0), size.x * size.y, 0.0, vec2(0.0));
}

// Variance of a point, px²: its size is that of the low-pass filter, beside which it vanishes.
const float POINT_VARIANCE = 1e-12;

// Image of a point of a fixed size, whatever its disc.
Image image_of_point() {
    return Image(Conic(vec2(0.0), vec2(1.0, 0.0), vec2(POINT_VARIANCE), vec2(0.0), 0.0), POINT_VARIANCE, 0.0, vec2(0.0));
}

Image image_of(Disc disc, float sigma, vec3 S, vec3 T) {
    if (FOOTPRINT == POINT) return image_of_point();
    if (FOOTPRINT == SQUARE) return image_of_square(disc, sigma);
    if (is_sprite()) return image_of_sprite(disc, sigma);
    return image_of_disc(disc, sigma, S, T);
}
