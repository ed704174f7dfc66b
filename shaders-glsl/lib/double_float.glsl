// Sums and products with their rounding errors (Dekker 1971; Ogita, Rump & Oishi 2005). A value is vec2(high, low).
// `precise` keeps the compiler from simplifying the errors away.

vec2 two_sum(float a, float b) {
    precise float sum = a + b;
    precise float virtual_b = sum - a;
    precise float error = (a - (sum - virtual_b)) + (b - virtual_b);
    return vec2(sum, error);
}

vec2 two_product(float a, float b) {
    precise float product = a * b;
    precise float a_hi = uintBitsToFloat(floatBitsToUint(a) & 0xfffff000u);
    precise float b_hi = uintBitsToFloat(floatBitsToUint(b) & 0xfffff000u);
    precise float a_lo = a - a_hi;
    precise float b_lo = b - b_hi;
    precise float error = a_lo * b_lo - (((product - a_hi * b_hi) - a_lo * b_hi) - a_hi * b_lo);
    return vec2(product, error);
}

// a + b.
vec2 add(vec2 a, vec2 b) {
    vec2 sum = two_sum(a.x, b.x);
    precise float low = sum.y + (a.y + b.y);
    precise float high = sum.x + low;
    precise float error = low - (high - sum.x);
    return vec2(high, error);
}

// a · b, where b is a single float.
vec2 scale(vec2 a, float b) {
    vec2 product = two_product(a.x, b);
    return vec2(product.x, product.y + a.y * b);
}

// a · b.
vec2 multiply(vec2 a, vec2 b) {
    return add(scale(a, b.x), vec2(a.x * b.y, 0.0));
}

// a / b.
vec2 divide(vec2 a, vec2 b) {
    float high = a.x / b.x;
    return vec2(high, add(a, -scale(b, high)).x / b.x);
}

// (a_hi + a_lo) · (b_hi + b_lo).
vec2 dot_double(vec3 a_hi, vec3 a_lo, vec3 b_hi, vec3 b_lo) {
    vec2 x = two_product(a_hi.x, b_hi.x), y = two_product(a_hi.y, b_hi.y), z = two_product(a_hi.z, b_hi.z);
    vec2 xy = two_sum(x.x, y.x);
    vec2 xyz = two_sum(xy.x, z.x);
    precise float low = (x.y + y.y) + z.y + (xy.y + xyz.y) + (dot(a_hi, b_lo) + dot(a_lo, b_hi));
    precise float high = xyz.x + low;
    precise float error = low - (high - xyz.x);
    return vec2(high, error);
}
