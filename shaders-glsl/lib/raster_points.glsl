// Nearest surfel of each pixel on the raster path: a depth, and an id + 1.
//
// Depth encodes the world distance without rounding: 1 at the near plane, one float less for every float that a distance is beyond it.
// Distinct distances have distinct depths up to 2^126 times the near plane's.

// With parallel rays the near plane may be at the eye or behind it: distances below 10⁻³⁰ of the far plane's are equal.
uint least_distance() {
    return floatBitsToUint(PERSPECTIVE ? frame.near : max(frame.near, 1e-30 / frame.key_slope));
}

const uint NEAR_PLANE_DEPTH = 0x3f800000; // 1.0
const uint LEAST_DEPTH = 0x00800000;      // the least float that no device flushes to 0

float depth_of(float distance) {
    uint beyond = max(floatBitsToUint(distance), least_distance()) - least_distance();
    return uintBitsToFloat(NEAR_PLANE_DEPTH - min(beyond, NEAR_PLANE_DEPTH - LEAST_DEPTH));
}

#ifdef COMPUTE

layout(set = 1, binding = 7) uniform texture2D nearest_depth;
layout(set = 1, binding = 8) uniform utexture2D nearest_id;

float distance_of(float depth) {
    return uintBitsToFloat(least_distance() + (NEAR_PLANE_DEPTH - floatBitsToUint(depth)));
}

// Reads the nearest point of a pixel; false if it has none.
bool raster_point(ivec2 pixel, out uint id, out float distance) {
    uint stored = texelFetch(nearest_id, pixel, 0).r;
    id = stored - 1;
    distance = distance_of(texelFetch(nearest_depth, pixel, 0).r);
    return stored != 0;
}

#endif
