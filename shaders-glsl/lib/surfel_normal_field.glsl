// Linear normal fields of surfels: see lib/normal_field.glsl.

#include "lib/normal_field.glsl"
#include "lib/surfel_normal.glsl"
#include "lib/square.glsl"

layout(constant_id = 84) const bool NORMAL_FIELDS = false; // the scene has curvatures, and the frame sums normals of fields

// Largest turn of the normal at the rim of a disc, as a tangent: curvatures of noisy points may be anything.
const float MOST_TURN = 1.0;
// Factor of the low-pass filter's variance: see FIELD_FILTER in src/verify/reference/ellipse.rs.
const float FIELD_FILTER = 7.0;
// Variance up to which fields are 0, in variances of the low-pass filter: see FLAT_VARIANCE in src/settings/splatting.rs.
const float FLAT_VARIANCE = 7.0;

// Change of the normal of surfel i, as the eye sees it, per σ of its attribute kernel along the kernel's axes: 0 if its curvature is unknown.
mat2x3 normal_field(uint i, Splat splat) {
    uint curvature = NORMAL_FIELDS && !is_billboard(i) ? curvature_of(i) : 0;
    if (curvature == 0) return mat2x3(0.0);
    vec3 normal = normal_of(i), to_eye = view.eye_hi.xyz - position_of(i) + view.eye_lo.xyz;
    mat2x3 basis = tangents(normal), axes = basis;
    float aspect = 1.0, radius = radius_of(i);
    if (ELLIPSES) {
        vec4 shape = ellipse_of(i);
        axes = ellipse_axes(normal, shape);
        aspect = shape.w;
    }
    mat2 square = square_of(splat, axes[0], aspect, normal, to_eye);
    vec2 variance = variance_of(splat), share = variance / attribute_variance(variance);
    vec2 kept = max(share - FLAT_VARIANCE * (1.0 - share), 0.0);
    // Shares of less than ⅞ keep nothing: the maximum only avoids 0 / 0.
    vec2 to_disc = kept / (sqrt(max(share, 0.5)) * mix(vec2(FIELD_FILTER), vec2(1.0), share));
    float largest = abs(largest_curvature(curvature)) * radius;
    float sigma = min(1.0, MOST_TURN / largest) * radius / frame.cutoff;
    mat2x3 field;
    for (int k = 0; k < 2; k++) {
        vec3 tangent = sigma * to_disc[k] * (axes * square[k]);
        field[k] = sign(splat.epsilon) * to_world(basis * turn_along(curvature, tangent * basis));
    }
    return field;
}
