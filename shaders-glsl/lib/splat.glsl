// Splats: written by the footprint pass, rasterized by visibility and attribute.

#include "lib/double_float.glsl"
#include "lib/clip.glsl"
#include "lib/footprint_kind.glsl"
#include "lib/shown_key.glsl"

layout(constant_id = 14) const bool WIDEN_SMALL = false; // the low-pass filter widens only axes shorter than itself
layout(constant_id = 16) const bool CONFETTI = false; // the kernel is ψ_E
layout(constant_id = 70) const bool CURVATURES = false; // discs of convex surfaces cover samples down to a depth only: see least_key
layout(constant_id = 67) const bool COVERAGE_FOOTPRINT = false; // α is coverage: visibility's footprint is that of the solid part

// Solid part of a footprint: discs are 1.3 times as large as needed, to leave no holes.
const float SOLID = 0.77;
// Half the side of a pixel, px.
const float HALF_PIXEL = 0.5;

struct Splat {
    vec2 offset;         // centre of the variance's ellipse relative to the anchor, px
    vec2 axis;           // unit major axis of the variance V
    float variance;      // V's larger eigenvalue, px²
    float detail;        // CONFETTI: angle from `axis`, which is rounded, to V's axis, rad; CURVATURES: see least_key; otherwise 0
    uint anchor;         // packed anchor pixel, DRAWN_SPLAT and BACK_SPLAT: see pack_anchor
    float epsilon;       // perspective: 1 / (1 + ε/z), a factor of κ, or DISTANT: what it is short of 1; orthographic: ε as a difference of κ;
                         // negative if the normal faces away
    vec3 plane_hi;       // κ of the tangent plane (has_linear_depth: distance) at the anchor, and its derivatives along x and y, per px, as
                         // sums of two floats
    float sqrt_det;      // √|V|, px²
    vec3 plane_lo;
    float key_disc;      // κ of the disc's nearest point
};

#ifdef WRITES_SPLATS
layout(set = 0, binding = 1, std430) writeonly buffer Splats { uvec4 splat_rows[]; };
layout(set = 0, binding = 1, std430) writeonly buffer SplatLayout { Splat splats[]; };
#elif defined(MODIFIES_SPLATS)
layout(set = 0, binding = 1, std430) buffer Splats { uvec4 splat_rows[]; };
#define splat_row(k) splat_rows[k]
#elif defined(TILE_PASS) && defined(SUBGROUPS)
layout(set = 1, binding = 17) uniform utextureBuffer splat_texels;
#define splat_row(k) texelFetch(splat_texels, int(k))
#elif defined(TILE_PASS)
layout(set = 1, binding = 7, std430) readonly buffer FrameSplats { uvec4 frame_splats[]; };
#define splat_row(k) frame_splats[k]
#elif !defined(FRAGMENT)
layout(set = 0, binding = 1, std430) readonly buffer Splats { uvec4 splat_rows[]; };
#define splat_row(k) splat_rows[k]
#endif

#if !defined(FRAGMENT) && !defined(TILE_PASS)
// Index of surfel i's splat in the bound buffer.
uint splat_index(uint i) {
#ifdef PER_CLUSTER
    if (CLUSTERS) return CLUSTER_SIZE * visible.slot + i % CLUSTER_SIZE;
#endif
    return instance_index() * chunk.instance_stride + i;
}
#endif

// Rows of four words: faster to load and store than single words.
#ifdef WRITES_SPLATS
void store_splat(uint index, Splat splat) {
    uint k = 4 * index;
    splat_rows[k] = floatBitsToUint(vec4(splat.offset, splat.axis));
    splat_rows[k + 1] = uvec4(floatBitsToUint(vec2(splat.variance, splat.detail)), splat.anchor, floatBitsToUint(splat.epsilon));
    splat_rows[k + 2] = floatBitsToUint(vec4(splat.plane_hi, splat.sqrt_det));
    splat_rows[k + 3] = floatBitsToUint(vec4(splat.plane_lo, splat.key_disc));
}

#endif
#if defined(WRITES_SPLATS) || defined(MODIFIES_SPLATS)
// Marks the splat of a culled surfel.
void store_culled(uint index) {
    splat_rows[4 * index + 1] = uvec4(0);
}
#endif
#if !defined(WRITES_SPLATS) && !defined(FRAGMENT)
// Loads splat i of the instance, or of the frame's list.
Splat splat_of(uint i) {
#ifdef TILE_PASS
    uint k = 4 * i;
#else
    uint k = 4 * splat_index(i);
#endif
    vec4 ellipse = uintBitsToFloat(splat_row(k));
    uvec4 row = splat_row(k + 1);
    vec4 plane_hi = uintBitsToFloat(splat_row(k + 2)), plane_lo = uintBitsToFloat(splat_row(k + 3));
    return Splat(ellipse.xy, ellipse.zw, uintBitsToFloat(row.x), uintBitsToFloat(row.y), row.z, uintBitsToFloat(row.w),
                 plane_hi.xyz, plane_hi.w, plane_lo.xyz, plane_lo.w);
}
#endif

const uint DRAWN_SPLAT = 1u << 30;
// The surfel faces away, and pass sides decides whether it is drawn.
const uint BACK_SPLAT = 1u << 31;

// The anchor is the pixel nearest to the centre: offsets from it keep their digits on large viewports.
uint pack_anchor(uvec2 pixel) {
    return pixel.x | pixel.y << 15 | DRAWN_SPLAT;
}

// Pixel centre of the anchor, px.
vec2 anchor_of(Splat splat) {
    return vec2(splat.anchor & 0x7fff, splat.anchor >> 15 & 0x7fff) + 0.5;
}

bool is_drawn(Splat splat) {
    return (splat.anchor & DRAWN_SPLAT) != 0;
}

// κ of the tangent plane down to which it covers samples: farther, the surface has turned away from the eye. 0: everywhere.
float least_key(Splat splat) {
    return CURVATURES ? splat.detail : 0.0;
}

// κ of the tangent plane down to which there are fragments: half a pixel beyond the samples that it covers.
float least_fragment_key(Splat splat) {
    return CURVATURES ? splat.detail - HALF_PIXEL * length(splat.plane_hi.yz) : 0.0;
}

bool is_back(Splat splat) {
    return (splat.anchor & BACK_SPLAT) != 0;
}

// V's eigenvalues, px²: their product is its determinant.
vec2 variance_of(Splat splat) {
    return vec2(splat.variance, splat.sqrt_det * (splat.sqrt_det / splat.variance));
}

// Half width and height, px, of the cut-off ellipse of a variance with this major axis and these eigenvalues.
vec2 half_extent(vec2 axis, vec2 variance) {
    vec2 axis2 = axis * axis;
    return frame.cutoff * sqrt(vec2(dot(axis2, variance), dot(axis2.yx, variance)));
}

// Factor from F σ of the affine ellipse to the footprint's extent for a variance: the kernel is largest where the plane is nearest to the
// eye.
float stretch_of(Splat splat, vec2 variance, float key_centre) {
    if (!on_plane()) return rim();
    vec2 minor_axis = vec2(-splat.axis.y, splat.axis.x);
    vec2 slope = vec2(dot(splat.plane_hi.yz, splat.axis), dot(splat.plane_hi.yz, minor_axis)) * sqrt(variance);
    float rise = rim() * frame.cutoff * length(slope) / inverse_depth(key_centre);
    // Rounding is far below the margin.
    return rim() * min(MOST_STRETCH, 1.0001 / max(1.0 - rise, 0.5));
}

// Variances of the two footprints along V's axes, px², from V's eigenvalues. Visibility's is just wide enough to contain a pixel centre; if α
// is coverage, its semi-axes are those of the solid part (lib/coverage.glsl) and half a pixel, so that it contains the centres of pixels of
// which that covers samples. Attribute's is V + H; with WIDEN_SMALL the larger of H and V as widened by a mask's visibility. It is at least
// visibility's, so that every visible pixel has attributes.
vec2 visibility_variance(vec2 variance) {
    if (!COVERAGE_FOOTPRINT) return variance + frame.visibility_lowpass;
    vec2 deviation = SOLID * sqrt(variance) + HALF_PIXEL / frame.cutoff;
    return max(deviation * deviation, frame.visibility_lowpass);
}

vec2 attribute_variance(vec2 variance) {
    vec2 widened = variance + frame.attribute_lowpass;
    if (WIDEN_SMALL) widened = max(variance + frame.visibility_lowpass, frame.attribute_lowpass);
    return COVERAGE_FOOTPRINT ? max(widened, visibility_variance(variance)) : widened;
}

// √(|V| / |V'|) of the filtered variance V': the filter's factor of the kernel's amplitude. The product of both eigenvalues would overflow
// on a very large splat.
float amplitude_of(Splat splat, vec2 variance) {
    vec2 inverse = inversesqrt(variance);
    return splat.sqrt_det * inverse.x * inverse.y;
}

// Least exponent of a Confetti kernel: the rim keeps some weight, so that every visible pixel has one.
const float LEAST_EXPONENT = -10.0;

// x^(n/2), by products if n is a small integer: pow has the error of a logarithm.
float half_power(float x, float n) {
    if (n != floor(n) || n > 16.0) return pow(x, 0.5 * n);
    float power = fract(0.5 * n) > 0.0 ? sqrt(x) : 1.0;
    uint whole = uint(0.5 * n);
    for (uint bit = 0; bit < 4; bit++) {
        power *= (whole >> bit & 1u) != 0 ? x : 1.0;
        x *= x;
    }
    return power;
}

// Kernel at the squared distance m2 from its centre, σ².
float kernel(float m2) {
    if (!CONFETTI) return exp(-0.5 * m2);
    float t = half_power(m2 / (frame.cutoff * frame.cutoff), frame.kernel_n);
    return exp(max(-frame.kernel_a * t / max(1.0 - t, 1e-6), LEAST_EXPONENT));
}

// A splat's footprint, as fragments evaluate it.
struct Ellipse {
    vec2 anchor;
    vec2 offset;      // the centre relative to the anchor, px
    vec4 whitening;   // rows of the matrix from px to σ
    mat2x4 fine;      // CONFETTI: rounding errors of the rows, see fine_row
    vec3 plane_hi;
    vec3 plane_lo;
    float key_centre; // on_plane: κ of the plane at the centre
    float least_key;  // CURVATURES: κ of the plane down to which there are fragments
    float key_disc;   // κ of the disc's nearest point
    uint clip;        // see screen_clip_index
};

// Value of a plane at d px from the anchor, with compensated rounding: an edge-on plane crosses all depths within a pixel, and large terms
// cancel along it.
float plane_at(vec3 hi, vec3 lo, vec2 d) {
    vec2 x = two_product(hi.y, d.x), y = two_product(hi.z, d.y);
    vec2 slope = two_sum(x.x, y.x);
    vec2 key = two_sum(slope.x, hi.x);
    return key.x + ((key.y + slope.y) + (x.y + y.y) + (lo.x + lo.y * d.x + lo.z * d.y));
}

// Scales a plane of two floats per coefficient.
void scale_plane(float factor, inout vec3 hi, inout vec3 lo) {
    for (int k = 0; k < 3; k++) {
        vec2 scaled = two_product(hi[k], factor);
        hi[k] = scaled.x;
        lo[k] = lo[k] * factor + scaled.y;
    }
}

float centre_key(vec3 hi, vec3 lo, vec2 offset) {
    return on_plane() ? plane_at(hi, lo, offset) : 0.0;
}

// A row of the whitening, an axis over its deviation, as a plane: its value at the anchor as the sum of two floats, and the rounding errors
// of its derivatives. At the tips of a thin ellipse the value is a small difference of large terms. `correction` is the axis's residual.
vec4 fine_row(vec2 axis, vec2 correction, float variance, vec2 offset) {
    float inverse = inversesqrt(variance);
    vec2 length2 = add(two_product(axis.x, axis.x), two_product(axis.y, axis.y));
    // Rounding error of the root and of the axis, which should give 1.
    vec2 unit = multiply(scale(two_product(inverse, inverse), variance), length2);
    float short_of = 0.5 * add(vec2(1.0, 0.0), -unit).x;
    vec2 x = two_product(axis.x, inverse), y = two_product(axis.y, inverse);
    vec2 error = vec2(x.y, y.y) + inverse * (short_of * axis + correction);
    vec2 to_centre = add(two_product(x.x, offset.x), two_product(y.x, offset.y));
    return vec4(-add(to_centre, vec2(dot(error, offset), 0.0)), error);
}

mat2x4 fine_rows(Splat splat, vec2 variance) {
    vec2 minor_axis = vec2(-splat.axis.y, splat.axis.x);
    return mat2x4(fine_row(splat.axis, splat.detail * minor_axis, variance.x, splat.offset),
                  fine_row(minor_axis, -splat.detail * splat.axis, variance.y, splat.offset));
}

Ellipse ellipse_of(Splat splat, vec2 variance, uint clip) {
    vec2 inverse = inversesqrt(variance);
    vec4 whitening = vec4(splat.axis * inverse.x, vec2(-splat.axis.y, splat.axis.x) * inverse.y);
    mat2x4 fine = CONFETTI ? fine_rows(splat, variance) : mat2x4(0.0);
    float key = centre_key(splat.plane_hi, splat.plane_lo, splat.offset);
    return Ellipse(
        anchor_of(splat), splat.offset, whitening, fine, splat.plane_hi, splat.plane_lo, key, least_fragment_key(splat), splat.key_disc, clip);
}

// Kernel coordinates along the ellipse's axes, σ, at d px from the anchor.
vec2 kernel_coordinates(Ellipse ellipse, vec2 d) {
    vec2 e = d - ellipse.offset;
    return vec2(dot(ellipse.whitening.xy, e), dot(ellipse.whitening.zw, e));
}

// Kernel coordinates with compensated rounding, for kernels with a steep rim.
vec2 fine_kernel_coordinates(Ellipse ellipse, vec2 d) {
    return vec2(plane_at(vec3(ellipse.fine[0].x, ellipse.whitening.xy), ellipse.fine[0].yzw, d),
                plane_at(vec3(ellipse.fine[1].x, ellipse.whitening.zw), ellipse.fine[1].yzw, d));
}

// Whether the splat has a fragment at a pixel centre: inside the rim, not clipped, and the plane within the depth range. m: kernel
// coordinates along the ellipse's axes, σ; key: κ of the plane; rank: see clip_rank.
bool splat_fragment(Ellipse ellipse, vec2 pixel, out vec2 m, out float key, out float rank) {
    vec2 d = pixel - ellipse.anchor;
    m = CONFETTI ? fine_kernel_coordinates(ellipse, d) : kernel_coordinates(ellipse, d);
    key = plane_at(ellipse.plane_hi, ellipse.plane_lo, d);
    // Fragments read distances in the world's unit.
    if (has_linear_depth()) key = world_key(key);
    // A homography that fixes the centre is affine up to the plane's distance.
    if (on_plane()) m /= clamp(inverse_depth(key) / inverse_depth(ellipse.key_centre), 1.0 / MOST_STRETCH, MOST_STRETCH);
    bool inside =
        rim() > 1.0 ? max(abs(m.x), abs(m.y)) <= frame.cutoff : dot(m, m) <= frame.cutoff * frame.cutoff;
    rank = 1.0;
    if (has_clip(ellipse.clip)) rank = clip_rank(clip_distance(screen_clip(ellipse.clip), d));
    if (CURVATURES) inside = inside && key >= ellipse.least_key;
    key = shown_key(key, ellipse.key_disc);
    return inside && rank > 0.0 && key > frame.key_far && key <= nearest_key();
}

#if !defined(FRAGMENT) && !defined(TILE_PASS)
// Upper bound of the κ of fragments within `stretch` cut-offs of the ellipse.
float nearest_of(Splat splat, vec2 variance, float stretch) {
    vec2 minor_axis = vec2(-splat.axis.y, splat.axis.x);
    vec2 slope = vec2(dot(splat.plane_hi.yz, splat.axis), dot(splat.plane_hi.yz, minor_axis)) * sqrt(variance);
    float rise = stretch * frame.cutoff * length(slope);
    float centre = splat.plane_hi.x + dot(splat.plane_hi.yz, splat.offset);
    // Above the rounding errors of these terms and of a fragment's κ.
    float margin = 1e-6 * (abs(splat.plane_hi.x) + abs(centre) + rise) + 1e-30;
    if (has_linear_depth()) return key_at_distance(max(centre - rise - margin, DISTANT ? -0.5 * view.distance_offset : 1e-30));
    return centre + rise + margin;
}
#endif

// ε of a splat relative to its distance, in perspective.
float relative_epsilon(float epsilon) {
    return DISTANT ? abs(epsilon) / (1.0 - abs(epsilon)) : 1.0 / abs(epsilon) - 1.0;
}

// κ that a fragment writes to visibility: moved away from the eye along the ray by the splat's ε, which divides it by 1 + ε/z. Never 0,
// which marks empty pixels.
//
// Never nearer than the disc itself: the low-pass widens an edge-on disc by most of a pixel, over which its plane extends far in front of
// it, and rims of hidden surfaces would show as dark lines.
float visibility_key(float key, float key_disc, float epsilon) {
    key = min(key, key_disc);
    if (DISTANT) return least_tested(key - inverse_depth(key) * abs(epsilon));
    return PERSPECTIVE ? key * abs(epsilon) : least_tested(key - abs(epsilon));
}
