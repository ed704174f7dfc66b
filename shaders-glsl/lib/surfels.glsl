// Streams of the bound chunk's surfels, in words of the bound ranges. Uploaded streams are packed, as the default constants describe; the
// buffers of a host have other layouts, and unvalidated values (UNCHECKED). Quantized surfels (LATTICES) have integer coordinates on the
// lattice of their cluster, half-float radii in its steps beside them, and octahedral normals: src/geometry/quantized.

#include "lib/cluster.glsl"
#include "lib/colour_streams.glsl"

layout(constant_id = 12) const bool ELLIPSES = false;
layout(constant_id = 13) const bool TWO_SIDED = false;
layout(constant_id = 22) const bool BILLBOARDS = false;  // a normal of 0 marks a billboard: a circle that faces the eye
layout(constant_id = 50) const uint POSITION_OFFSET = 0;
layout(constant_id = 51) const uint POSITION_STRIDE = 3;
layout(constant_id = 52) const uint NORMAL_OFFSET = 0;
layout(constant_id = 53) const uint NORMAL_STRIDE = 3;
layout(constant_id = 54) const uint NORMALS = 0;         // format of normals
layout(constant_id = 55) const uint RADIUS_OFFSET = 0;
layout(constant_id = 56) const uint RADIUS_STRIDE = 1;   // 0: one radius for all
layout(constant_id = 57) const uint COLOUR_OFFSET = 0;
layout(constant_id = 58) const uint COLOUR_STRIDE = 1;
layout(constant_id = 59) const uint ELLIPSE_OFFSET = 0;
layout(constant_id = 60) const uint ELLIPSE_STRIDE = 4;
layout(constant_id = 61) const bool UNCHECKED = false;   // surfels are not validated
layout(constant_id = 62) const uint STORED_COLOURS = 0;  // colour format of the scene, also if the frame reads no colours
layout(constant_id = 78) const bool LATTICES = false;    // surfels are quantized

layout(set = 0, binding = 2, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 3, std430) readonly buffer Normals { uint normals[]; };
layout(set = 0, binding = 4, std430) readonly buffer Radii { float radii[]; }; // 0: invalid; TWO_SIDED: negative for two-sided surfels
// LATTICES, in place of positions and radii; the latter by cluster: the corner and the step, or the index of its exact surfels and 0. Exact
// surfels are positions and radii.
layout(set = 0, binding = 2, std430) readonly buffer LatticePositions { uvec2 lattice_positions[]; };
layout(set = 0, binding = 4, std430) readonly buffer Lattices { uvec4 lattices[]; };
layout(set = 0, binding = 5, std430) readonly buffer Colours { uint colours[]; };
layout(set = 0, binding = 8, std430) readonly buffer Ellipses { vec4 ellipses[]; }; // major axis, aspect
layout(set = 0, binding = 8, std430) readonly buffer EllipseWords { uint ellipse_words[]; };

const uint FLOAT_NORMALS = 0, SNORM8_NORMALS = 1, SNORM16_NORMALS = 2, HALF_NORMALS = 3, OCTAHEDRAL_NORMALS = 4;
const uint NORMALS_WITH_CURVATURES = 5; // octahedral codes of 23 bits above the lower bits of curvatures
// Octahedral codes of billboards.
const uint NO_NORMAL = 0x80008000u, NO_COARSE_NORMAL = 0xffffffffu;
const int COARSE_NORMAL = 1447, COARSE_VALUES = 2 * COARSE_NORMAL + 1; // largest coordinate of a code of 23 bits, and their number
const uint CURVATURE_BITS = 9; // of curvatures beside normals; three more are those above the coordinates
const int LEAST_CURVATURE = -9, CURVATURE_LINES = 12;
// Shapes of one sign; shapes of either sign, and those of saddles, whose signs are equal but for a quarter turn.
const int SIGNED_SHAPES = 1 + 3 * CURVATURE_LINES, CURVATURE_SHAPES = 2 * SIGNED_SHAPES + CURVATURE_LINES;
const uint CURVATURE_ROOTS = 0x57351800u; // bytes: mantissas of the powers of 2¼

DEFINE_COLOURS(stored_colour, STORED_COLOURS, colours, COLOUR_OFFSET, COLOUR_STRIDE)

// Position and radius of a quantized surfel. A step is a power of two and the corner a multiple of it, so that positions are exact.
vec4 lattice_surfel(uint i) {
    uvec4 lattice = lattices[i / CLUSTER_SIZE];
    if (lattice.w == 0u) return uintBitsToFloat(lattices[lattice.x + i % CLUSTER_SIZE]);
    uvec2 words = lattice_positions[i];
    vec4 steps = vec4(words.x & 0x7fffu, words.x >> 16 & 0x7fffu, words.y & 0x7fffu, unpackHalf2x16(words.y).y);
    return vec4(uintBitsToFloat(lattice.xyz), 0.0) + uintBitsToFloat(lattice.w) * steps;
}

vec3 position_of(uint i) {
    if (LATTICES) return lattice_surfel(i).xyz;
    uint k = POSITION_OFFSET + POSITION_STRIDE * i;
    return vec3(positions[k], positions[k + 1], positions[k + 2]);
}

// Direction of a point of the octahedron |x| + |y| + |z| = most that is unfolded to a square (Cigolle et al., *A Survey of Efficient
// Representations for Independent Unit Vectors*, 2014). In integers, so that all devices find the same.
vec3 octahedral_direction(ivec2 code, int most) {
    int z = most - abs(code.x) - abs(code.y);
    ivec2 signs = ivec2(code.x >= 0 ? 1 : -1, code.y >= 0 ? 1 : -1);
    return vec3(z >= 0 ? code : signs * (most - abs(code.yx)), z);
}

// As stored: packed formats are not unit vectors.
vec3 stored_normal(uint i) {
    uint k = NORMAL_OFFSET + NORMAL_STRIDE * i;
    if (NORMALS == OCTAHEDRAL_NORMALS) {
        int code = int(normals[k]);
        return normals[k] == NO_NORMAL ? vec3(0.0) : octahedral_direction(ivec2(bitfieldExtract(code, 0, 16), code >> 16), 32767);
    }
    if (NORMALS == NORMALS_WITH_CURVATURES) {
        int pair = int(normals[k] >> CURVATURE_BITS);
        ivec2 code = ivec2(pair % COARSE_VALUES, pair / COARSE_VALUES) - COARSE_NORMAL;
        return normals[k] == NO_COARSE_NORMAL ? vec3(0.0) : octahedral_direction(code, COARSE_NORMAL);
    }
    if (NORMALS == SNORM8_NORMALS) return unpackSnorm4x8(normals[k]).xyz;
    if (NORMALS == SNORM16_NORMALS) return vec3(unpackSnorm2x16(normals[k]), unpackSnorm2x16(normals[k + 1]).x);
    if (NORMALS == HALF_NORMALS) return vec3(unpackHalf2x16(normals[k]), unpackHalf2x16(normals[k + 1]).x);
    return uintBitsToFloat(uvec3(normals[k], normals[k + 1], normals[k + 2]));
}

// Principal curvature of the larger magnitude, 1 / unit.
float largest_curvature(uint curvature) {
    return uintBitsToFloat(curvature & 0xffff0000u);
}

// Its direction, and the other principal curvature divided by it.
vec3 curvature_shape(uint curvature) {
    vec2 shape = unpackSnorm4x8(curvature).xy;
    float angle = 1.5707963 * shape.y;
    return vec3(cos(angle), sin(angle), shape.x);
}

// Normal curvature, 1 / unit, in the direction of a tangent: above 0 where the surface bends away from the normal (Euler's formula).
float curvature_along(uint curvature, vec2 tangent) {
    vec3 shape = curvature_shape(curvature);
    float along = dot(tangent, shape.xy);
    return largest_curvature(curvature) * mix(shape.z, 1.0, along * along / max(dot(tangent, tangent), 1e-30));
}

// Change of the normal along a tangent of this length: the shape operator applied to the tangent.
vec2 turn_along(uint curvature, vec2 tangent) {
    vec3 shape = curvature_shape(curvature);
    return largest_curvature(curvature) * (shape.z * tangent + (1.0 - shape.z) * dot(shape.xy, tangent) * shape.xy);
}

bool is_billboard(uint i) {
    return BILLBOARDS && stored_normal(i) == vec3(0.0);
}

float stored_radius(uint i) {
    if (LATTICES) return lattice_surfel(i).w;
    return radii[RADIUS_OFFSET + RADIUS_STRIDE * i];
}

float radius_of(uint i) {
    return TWO_SIDED ? abs(stored_radius(i)) : stored_radius(i);
}

bool is_two_sided(uint i) {
    return TWO_SIDED && stored_radius(i) < 0.0;
}

// Curvature of a disc with this radius, of a code that is not 0: one of 42 sizes, quarter powers of two from 2^LEAST_CURVATURE on relative to
// the radius, by one of the shapes (src/geometry/quantized/curvatures.rs).
uint decoded_curvature(int code, float radius) {
    int size = (code - 1) / CURVATURE_SHAPES, shape = (code - 1) % CURVATURE_SHAPES;
    int exponent = clamp(127 + LEAST_CURVATURE + size / 4 - (int(floatBitsToUint(radius) >> 23) - 127), 1, 254);
    int root = int(CURVATURE_ROOTS >> 8 * (size % 4)) & 0xff;
    bool saddle = shape >= 2 * SIGNED_SHAPES, negative = shape >= SIGNED_SHAPES && !saddle;
    // Saddles follow those of one sign.
    shape -= saddle || negative ? SIGNED_SHAPES : 0;
    int steps = (shape - 1) / CURVATURE_LINES, line = (shape - 1) % CURVATURE_LINES;
    int ratio = shape == 0 ? 127 : max(63 - 64 * steps, -127), angle = shape == 0 ? 0 : 127 * line / 6 - 127;
    return (negative ? 0x80000000u : 0) | uint(exponent << 23 | root << 16 | (angle & 0xff) << 8 | ratio & 0xff);
}

// Curvature of surfel i's surface in the format of src/geometry/curvature.rs; 0 if it is unknown.
uint curvature_of(uint i) {
    uint k = NORMAL_OFFSET + NORMAL_STRIDE * i;
    if (NORMALS != NORMALS_WITH_CURVATURES) return normals[k + 3];
    uvec2 words = lattice_positions[i];
    uint upper = words.x >> 15 & 1u | words.x >> 30 & 2u | words.y >> 13 & 4u;
    int code = int(upper << CURVATURE_BITS | normals[k] & (1u << CURVATURE_BITS) - 1u);
    return code == 0 ? 0u : decoded_curvature(code, radius_of(i));
}

// Direction of the major axis of surfel i's disc, a unit vector but for quantized surfels, and its aspect.
vec4 ellipse_of(uint i) {
    if (LATTICES) {
        int word = int(ellipse_words[i]);
        ivec2 axis = ivec2(bitfieldExtract(word, 0, 11), bitfieldExtract(word, 11, 11));
        return vec4(octahedral_direction(axis, 1023), float(ellipse_words[i] >> 22) / 1023.0);
    }
    if (ELLIPSE_STRIDE == 4 && ELLIPSE_OFFSET % 4 == 0) return ellipses[i + ELLIPSE_OFFSET / 4];
    uint k = ELLIPSE_OFFSET + ELLIPSE_STRIDE * i;
    return uintBitsToFloat(uvec4(ellipse_words[k], ellipse_words[k + 1], ellipse_words[k + 2], ellipse_words[k + 3]));
}

const float LARGEST_VALUE = 1e15;
const float UNIT_TOLERANCE = 1e-3;        // tolerance of the squared length of a unit vector
const float PACKED_UNIT_TOLERANCE = 0.03; // of a vector rounded to 8 bits per coordinate

// Compares bits: NaN has greater ones, and compilers may assume that floats are not NaN.
bool is_bounded(vec3 v) {
    return all(lessThanEqual(floatBitsToUint(v) & 0x7fffffffu, uvec3(floatBitsToUint(LARGEST_VALUE))));
}

// Whether no value is NaN: compares bits, too.
bool are_numbers(vec4 v) {
    return all(lessThanEqual(floatBitsToUint(v) & 0x7fffffffu, uvec4(0x7f800000u)));
}

bool is_number(float v) {
    return (floatBitsToUint(v) & 0x7fffffffu) <= 0x7f800000u;
}

bool is_unit(vec3 v, float tolerance) {
    return is_bounded(v) && abs(dot(v, v) - 1.0) <= tolerance;
}

// Whether surfel i can be drawn: Surfels::is_valid for the buffers of a host.
bool is_valid(uint i) {
    float radius = radius_of(i);
    if (!UNCHECKED) return radius > 0.0;
    if (!is_bounded(vec3(radius)) || !(radius > 0.0) || !is_bounded(position_of(i))) return false;
    bool billboard = is_billboard(i);
    vec3 normal = stored_normal(i);
    if (!billboard && !is_unit(normal, NORMALS == FLOAT_NORMALS ? UNIT_TOLERANCE : PACKED_UNIT_TOLERANCE)) return false;
    if (STORED_COLOURS != COLOURS_NONE && !is_bounded(stored_colour(i))) return false;
    if (!ELLIPSES || billboard) return true;
    if (NORMALS != FLOAT_NORMALS) normal = normalize(normal);
    vec4 shape = ellipse_of(i);
    bool orthogonal = is_unit(shape.xyz, UNIT_TOLERANCE) && is_unit(cross(normal, shape.xyz), UNIT_TOLERANCE);
    return orthogonal && is_bounded(vec3(shape.w)) && shape.w > 0.0 && shape.w <= 1.0;
}
