// The nearest surfel of each pixel where surfels are drawn: a depth, and a number from 1 on.
//
// Depth is of distances in the world: 1 at the near plane and falls by one float for every float that a distance is beyond: nothing is rounded, and two distances have
// two depths, as far as 2^126 times as far as the near plane.

// Of parallel rays, whose near plane may be at the eye or behind it, what is 10⁻³⁰ of the far plane's distance is as near as can be.
uint least_distance() {
    return floatBitsToUint(PERSPECTIVE ? frame.near : max(frame.near, 1e-30 / frame.key_slope));
}

const uint AT_NEAR_PLANE = 0x3f800000; // 1.0
const uint AT_MOST_FAR = 0x00800000;   // the least float that no device takes for 0

float depth_of(float distance) {
    uint beyond = max(floatBitsToUint(distance), least_distance()) - least_distance();
    return uintBitsToFloat(AT_NEAR_PLANE - min(beyond, AT_NEAR_PLANE - AT_MOST_FAR));
}

#ifdef COMPUTE

layout(set = 1, binding = 7) uniform texture2D nearest_depth;
layout(set = 1, binding = 8) uniform utexture2D nearest_number;

float distance_of(float depth) {
    return uintBitsToFloat(least_distance() + (AT_NEAR_PLANE - floatBitsToUint(depth)));
}

// False where there is none.
bool drawn_point(ivec2 at, out uint number, out float distance) {
    uint drawn = texelFetch(nearest_number, at, 0).r;
    number = drawn - 1;
    distance = distance_of(texelFetch(nearest_depth, at, 0).r);
    return drawn != 0;
}

#endif
