// A splat: what the footprint pass makes of a surfel, and what visibility and attribute draw.

#include "lib/double_float.glsl"
#include "lib/clip.glsl"

layout(constant_id = 14) const bool WIDEN_SMALL = false; // the low-pass filter widens only what is smaller than itself
layout(constant_id = 15) const uint FOOTPRINT = 0;        // as in src/settings/splatting.rs
layout(constant_id = 16) const bool CONFETTI = false;     // the kernel is ψ_E

const uint CONIC = 0, AFFINE = 1, PARALLELOGRAM = 2, DISC = 3, SPRITE = 4, WHOLE_SPRITE = 5, SQUARE = 6;

// Whether the kernel lies in the tangent plane.
bool on_plane() {
    return PERSPECTIVE && (FOOTPRINT == PARALLELOGRAM || FOOTPRINT == DISC);
}

bool is_sprite() {
    return FOOTPRINT == SPRITE || FOOTPRINT == WHOLE_SPRITE;
}

// Whether the distance from the eye, not its inverse, is affine on the screen.
bool has_linear_depth() {
    return PERSPECTIVE && is_sprite();
}

// Half the diagonal of a footprint whose semi-axes are 1: it ends on a square about them, or on an ellipse.
float rim() {
    return FOOTPRINT == PARALLELOGRAM || FOOTPRINT == SQUARE ? 1.4142137 : 1.0;
}

struct Splat {
    vec2 offset;    // centre of the variance's ellipse relative to the anchor, px
    vec2 axis;      // unit major axis of the variance V
    float variance; // V's larger eigenvalue, px²
    float turn;     // how far V's axis is turned from `axis`, which is rounded, rad; CONFETTI, otherwise 0
    uint place;     // anchor, and whether it is drawn: see below
    float epsilon;  // perspective: 1 / (1 + ε/z), scales κ; orthographic: ε as a difference of κ; negative: the normal faces away
    vec3 plane_hi;  // κ of the tangent plane (has_linear_depth: distance) at the anchor, and its derivatives along x and y, per px, as
                    // sums of two floats
    float sqrt_det; // √|V|, px²
    vec3 plane_lo;
    float key_disc; // κ of the disc's nearest point
};

#ifdef WRITES_SPLATS
layout(set = 0, binding = 1, std430) writeonly buffer Splats { uvec4 splat_rows[]; };
layout(set = 0, binding = 1, std430) writeonly buffer SplatLayout { Splat splats[]; };
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
// Where the instance has splat i.
uint splat_number(uint i) {
    return instance_number() * window.room + i;
}
#endif

// Splats are loaded and stored as rows of four words, which is faster than word by word.
#ifdef WRITES_SPLATS
void store_splat(uint number, Splat splat) {
    uint k = 4 * number;
    splat_rows[k] = floatBitsToUint(vec4(splat.offset, splat.axis));
    splat_rows[k + 1] = uvec4(floatBitsToUint(vec2(splat.variance, splat.turn)), splat.place, floatBitsToUint(splat.epsilon));
    splat_rows[k + 2] = floatBitsToUint(vec4(splat.plane_hi, splat.sqrt_det));
    splat_rows[k + 3] = floatBitsToUint(vec4(splat.plane_lo, splat.key_disc));
}

// Of a surfel that is culled.
void store_no_splat(uint number) {
    splat_rows[4 * number + 1] = uvec4(0);
}
#elif !defined(FRAGMENT)
// Splat i of the instance, or of the frame.
Splat splat_of(uint i) {
#ifdef TILE_PASS
    uint k = 4 * i;
#else
    uint k = 4 * splat_number(i);
#endif
    vec4 ellipse = uintBitsToFloat(splat_row(k));
    uvec4 rest = splat_row(k + 1);
    vec4 plane_hi = uintBitsToFloat(splat_row(k + 2)), plane_lo = uintBitsToFloat(splat_row(k + 3));
    return Splat(ellipse.xy, ellipse.zw, uintBitsToFloat(rest.x), uintBitsToFloat(rest.y), rest.z, uintBitsToFloat(rest.w),
                 plane_hi.xyz, plane_hi.w, plane_lo.xyz, plane_lo.w);
}
#endif

const uint DRAWN_SPLAT = 1;

// The anchor is the pixel nearest to the centre: what is given relative to it keeps its digits on large pictures.
uint place_of(uvec2 pixel) {
    return pixel.x | pixel.y << 15 | DRAWN_SPLAT << 30;
}

// The pixel centre of the anchor, px.
vec2 anchor_of(Splat splat) {
    return vec2(splat.place & 0x7fff, splat.place >> 15 & 0x7fff) + 0.5;
}

bool is_drawn(Splat splat) {
    return splat.place >> 30 == DRAWN_SPLAT;
}

// V's eigenvalues, px²: their product is its determinant.
vec2 variance_of(Splat splat) {
    return vec2(splat.variance, splat.sqrt_det * (splat.sqrt_det / splat.variance));
}

// Largest factor by which perspective may shrink or enlarge a kernel that lies in the tangent plane, against its centre: further out the
// plane nears its horizon, and a parallelogram would reach behind the eye.
const float MOST_STRETCH = 2.0;

// How far beyond F σ of the affine ellipse a footprint can reach, as a factor, at most.
float most_reach() {
    return on_plane() ? MOST_STRETCH * rim() : rim();
}

// Half the width and height, px, of the cut-off ellipse of a variance that is given by its major axis and eigenvalues.
vec2 reach_of(vec2 axis, vec2 variance) {
    vec2 axis2 = axis * axis;
    return frame.cutoff * sqrt(vec2(dot(axis2, variance), dot(axis2.yx, variance)));
}

// The same factor for a splat of the given variance: where the plane is nearest to the eye, the kernel is largest.
float stretch_of(Splat splat, vec2 variance, float key_centre) {
    if (!on_plane()) return rim();
    vec2 minor_axis = vec2(-splat.axis.y, splat.axis.x);
    vec2 slope = vec2(dot(splat.plane_hi.yz, splat.axis), dot(splat.plane_hi.yz, minor_axis)) * sqrt(variance);
    float rise = rim() * frame.cutoff * length(slope) / key_centre;
    // Rounding moves either by far less than the margin.
    return rim() * min(MOST_STRETCH, 1.0001 / max(1.0 - rise, 0.5));
}

// The variances of a splat's two footprints along V's axes, from V's eigenvalues, px². Visibility's is just wide enough to own a
// pixel centre. Attribute's is V + H, or with WIDEN_SMALL at least H and otherwise visibility's. It is never less than that, so
// that no pixel which visibility owns is left without attributes.
vec2 visibility_variance(vec2 variance) {
    return variance + frame.visibility_lowpass;
}

vec2 attribute_variance(vec2 variance) {
    if (WIDEN_SMALL) return max(visibility_variance(variance), frame.attribute_lowpass);
    return variance + frame.attribute_lowpass;
}

// √(|V| / |V'|), of the filtered variance V': what the filter leaves of the kernel's height. The product of both eigenvalues would
// overflow on a very large splat.
float amplitude_of(Splat splat, vec2 variance) {
    vec2 inverse = inversesqrt(variance);
    return splat.sqrt_det * inverse.x * inverse.y;
}

// Least exponent of a Confetti kernel: the rim keeps some weight, so that no pixel which visibility owns is left without.
const float LEAST_EXPONENT = -10.0;

// x^(n/2), of a small whole n by products: pow is as far off as a logarithm.
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

// The kernel at the squared distance m2 from its centre, σ².
float kernel(float m2) {
    if (!CONFETTI) return exp(-0.5 * m2);
    float t = half_power(m2 / (frame.cutoff * frame.cutoff), frame.kernel_n);
    return exp(max(-frame.kernel_a * t / max(1.0 - t, 1e-6), LEAST_EXPONENT));
}

// What a fragment needs of a splat.
struct Ellipse {
    vec2 anchor;
    vec2 offset;    // the centre relative to the anchor, px
    vec4 whitening; // rows of the map from px to σ
    mat2x4 fine;    // CONFETTI: what the rows lack, see fine_row
    vec3 plane_hi;
    vec3 plane_lo;
    float key_centre; // on_plane: κ of the plane at the centre
    uint clip;        // see screen_clip_number
};

// The plane's value at d px from the anchor. Seen edge-on, the plane runs through all depths within a pixel, and along its image large
// terms cancel.
float plane_at(vec3 hi, vec3 lo, vec2 d) {
    vec2 x = two_product(hi.y, d.x), y = two_product(hi.z, d.y);
    vec2 slope = two_sum(x.x, y.x);
    vec2 key = two_sum(slope.x, hi.x);
    return key.x + ((key.y + slope.y) + (x.y + y.y) + (lo.x + lo.y * d.x + lo.z * d.y));
}

// Scales a plane.
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

// A row of the whitening, an axis over its deviation, as a plane: its value at the anchor as the sum of two floats, and of its derivatives
// what floats leave over. At the tips of a thin ellipse the row's value is a small difference of large terms. `turned` is what turning the
// axis adds to it.
vec4 fine_row(vec2 axis, vec2 turned, float variance, vec2 offset) {
    float inverse = inversesqrt(variance);
    vec2 length2 = add(two_product(axis.x, axis.x), two_product(axis.y, axis.y));
    // What the rounding of the root and of the axis has made of 1.
    vec2 unit = multiply(scale(two_product(inverse, inverse), variance), length2);
    float short_of = 0.5 * add(vec2(1.0, 0.0), -unit).x;
    vec2 x = two_product(axis.x, inverse), y = two_product(axis.y, inverse);
    vec2 rest = vec2(x.y, y.y) + inverse * (short_of * axis + turned);
    vec2 to_centre = add(two_product(x.x, offset.x), two_product(y.x, offset.y));
    return vec4(-add(to_centre, vec2(dot(rest, offset), 0.0)), rest);
}

mat2x4 fine_rows(Splat splat, vec2 variance) {
    vec2 minor_axis = vec2(-splat.axis.y, splat.axis.x);
    return mat2x4(fine_row(splat.axis, splat.turn * minor_axis, variance.x, splat.offset),
                  fine_row(minor_axis, -splat.turn * splat.axis, variance.y, splat.offset));
}

Ellipse ellipse_of(Splat splat, vec2 variance, uint clip) {
    vec2 inverse = inversesqrt(variance);
    vec4 whitening = vec4(splat.axis * inverse.x, vec2(-splat.axis.y, splat.axis.x) * inverse.y);
    mat2x4 fine = CONFETTI ? fine_rows(splat, variance) : mat2x4(0.0);
    float key = centre_key(splat.plane_hi, splat.plane_lo, splat.offset);
    return Ellipse(anchor_of(splat), splat.offset, whitening, fine, splat.plane_hi, splat.plane_lo, key, clip);
}

// The place in the kernel along the ellipse's axes, σ, at d px from the anchor.
vec2 place(Ellipse ellipse, vec2 d) {
    vec2 e = d - ellipse.offset;
    return vec2(dot(ellipse.whitening.xy, e), dot(ellipse.whitening.zw, e));
}

// The same where a steep rim shows what is lost in that.
vec2 fine_place(Ellipse ellipse, vec2 d) {
    return vec2(plane_at(vec3(ellipse.fine[0].x, ellipse.whitening.xy), ellipse.fine[0].yzw, d),
                plane_at(vec3(ellipse.fine[1].x, ellipse.whitening.zw), ellipse.fine[1].yzw, d));
}

// The near plane's distance in the unit of the plane that a fragment sees.
float fragment_near() {
#if defined(FRAGMENT) || defined(TILE_PASS)
    return frame.near;
#else
    return view.near;
#endif
}

// Whether the splat has a fragment at a pixel centre: it is within the rim and not clipped, and the tangent plane within the depth range.
// m: place in the kernel along the ellipse's axes, σ; key: the plane's κ; rank: see clip_rank.
bool splat_fragment(Ellipse ellipse, vec2 pixel, out vec2 m, out float key, out float rank) {
    vec2 d = pixel - ellipse.anchor;
    m = CONFETTI ? fine_place(ellipse, d) : place(ellipse, d);
    key = plane_at(ellipse.plane_hi, ellipse.plane_lo, d);
    if (has_linear_depth()) key = key > 0.0 ? fragment_near() / key : 2.0;
    // A homography that keeps the centre is affine but for the plane's distance.
    if (on_plane()) m /= clamp(key / ellipse.key_centre, 1.0 / MOST_STRETCH, MOST_STRETCH);
    bool inside =
        rim() > 1.0 ? max(abs(m.x), abs(m.y)) <= frame.cutoff : dot(m, m) <= frame.cutoff * frame.cutoff;
    rank = 1.0;
    if (has_clip(ellipse.clip)) rank = clip_rank(clip_distance(screen_clip(ellipse.clip), d));
    return inside && rank > 0.0 && key > frame.key_far && key <= 1.0;
}

#if !defined(FRAGMENT) && !defined(TILE_PASS)
// The nearest κ within `stretch` cut-offs of the ellipse: no fragment's is above it.
float nearest_of(Splat splat, vec2 variance, float stretch) {
    vec2 minor_axis = vec2(-splat.axis.y, splat.axis.x);
    vec2 slope = vec2(dot(splat.plane_hi.yz, splat.axis), dot(splat.plane_hi.yz, minor_axis)) * sqrt(variance);
    float rise = stretch * frame.cutoff * length(slope);
    float centre = splat.plane_hi.x + dot(splat.plane_hi.yz, splat.offset);
    // More than what the rounding of any of these, or of a fragment's κ, takes away.
    float margin = 1e-6 * (abs(splat.plane_hi.x) + abs(centre) + rise) + 1e-30;
    if (has_linear_depth()) return view.near / max(centre - rise - margin, 1e-30);
    return centre + rise + margin;
}
#endif

// κ that a fragment writes to visibility: moved away from the eye along the ray by the splat's ε, which divides it by 1 + ε/z. Never
// 0: that means nothing is there.
//
// Nothing is claimed nearer than the disc itself. The low-pass widens a disc seen edge-on by most of a pixel, over which its plane
// runs far out in front of it; rims of hidden surfaces would show through as dark lines.
float visibility_key(float key, float key_disc, float epsilon) {
    key = min(key, key_disc);
    return PERSPECTIVE ? key * abs(epsilon) : max(key - abs(epsilon), 1e-6);
}
