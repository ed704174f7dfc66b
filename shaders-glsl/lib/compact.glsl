// Compact formats of samples, rounded alike on all devices (src/verify/reference/pull_push/compact.rs).

// Greatest half float.
const float MOST_HALF = 65504.0;
// Greatest value of the shared-exponent format.
const float MOST_SHARED = 65408.0;
// Code of a zero vector: packSnorm2x16 returns -32767 at least.
const uint NO_DIRECTION = 0x80008000u;

// Rounds to two half floats, to nearest. The rounding of packHalf2x16 is implementation-defined: it gets values that need none, except
// denormals.
uint pack_halves(vec2 v) {
    uvec2 bits = floatBitsToUint(clamp(v, -MOST_HALF, MOST_HALF));
    return packHalf2x16(uintBitsToFloat((bits + 0x1000u) & 0xffffe000u));
}

// A value of at least 0 in 16 bits, 8 of exponent and 8 of fraction: the range of half floats is too small for lengths in any unit.
uint pack_length(float v) {
    return (floatBitsToUint(v) + 0x4000u) >> 15;
}

float unpack_length(uint bits) {
    return uintBitsToFloat(bits << 15);
}

vec2 folded(vec2 p) {
    return (1.0 - abs(p.yx)) * mix(vec2(-1.0), vec2(1.0), greaterThanEqual(p, vec2(0.0)));
}

// A direction as a point on an octahedron (Cigolle et al. 2014, "oct32").
uint pack_direction(vec3 v) {
    vec2 p = v.xy / (abs(v.x) + abs(v.y) + abs(v.z));
    return v == vec3(0.0) ? NO_DIRECTION : packSnorm2x16(v.z < 0.0 ? folded(p) : p);
}

vec3 unpack_direction(uint bits) {
    vec2 p = unpackSnorm2x16(bits);
    float z = 1.0 - abs(p.x) - abs(p.y);
    return bits == NO_DIRECTION ? vec3(0.0) : normalize(vec3(z < 0.0 ? folded(p) : p, z));
}

// A linear colour up to 1 by its square roots, 10 bits each: four times the resolution of 8-bit sRGB, without pow.
uint pack_roots(vec3 v) {
    uvec3 bits = uvec3(sqrt(clamp(v, 0.0, 1.0)) * 1023.0 + 0.5);
    return bits.x | bits.y << 10 | bits.z << 20;
}

vec3 unpack_roots(uint bits) {
    vec3 roots = vec3(bits & 1023u, bits >> 10 & 1023u, bits >> 20 & 1023u) / 1023.0;
    return roots * roots;
}

float power_of_two(int exponent) {
    return uintBitsToFloat(uint(exponent + 127) << 23);
}

// A linear colour with channels above 1: 9 bits each with a shared exponent (VK_FORMAT_E5B9G9R9_UFLOAT_PACK32).
uint pack_shared(vec3 v) {
    vec3 c = clamp(v, 0.0, MOST_SHARED);
    float most = max(c.x, max(c.y, c.z));
    int exponent = max(int(floatBitsToUint(most) >> 23) - 127, -16) + 1;
    // A mantissa that rounds up to 512 is 256 with the next exponent.
    if (floor(most / power_of_two(exponent - 9) + 0.5) > 511.0) exponent++;
    uvec3 bits = uvec3(c / power_of_two(exponent - 9) + 0.5);
    return bits.x | bits.y << 9 | bits.z << 18 | uint(exponent + 15) << 27;
}

vec3 unpack_shared(uint bits) {
    return vec3(bits & 511u, bits >> 9 & 511u, bits >> 18 & 511u) * power_of_two(int(bits >> 27) - 24);
}
