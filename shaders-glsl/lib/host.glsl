// Output to the targets of a host: blended colour, and depth in the host's encoding.

layout(constant_id = 40) const bool HOST_DEPTH = false; // the host has a depth attachment
layout(constant_id = 41) const bool ENCODE = false;     // the shader encodes sRGB: the host's format does not

// Pixels that the draw covers: all with a surface; those of α ≥ ½, which write depth, normals and ids; or the others, which only blend. Where
// most of a pixel shows the surface behind, that is the one whose depth later draws need.
layout(constant_id = 44) const uint DRAWN_ALPHA = 0;
const uint ANY_ALPHA = 0, MOST_COVERED = 1, LEAST_COVERED = 2;

bool is_drawn(float alpha) {
    return alpha > 0.0 && (DRAWN_ALPHA == ANY_ALPHA || (alpha >= 0.5) == (DRAWN_ALPHA == MOST_COVERED));
}

vec3 linear_to_srgb(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

// Premultiplied output of a linear colour with α.
vec4 over_host(vec4 linear) {
    vec3 colour = ENCODE ? linear_to_srgb(clamp(linear.rgb, 0.0, 1.0)) : linear.rgb;
    return vec4(linear.a * colour, linear.a);
}

// The host's depth at distance z: depth.x + depth.y / z in perspective, depth.x + depth.y z otherwise, clamped to depth.zw.
float host_depth(vec4 depth, float z) {
    // A disc whose centre is in front of the near plane may have a rim nearer than it.
    return clamp(depth.x + depth.y * (PERSPECTIVE ? 1.0 / z : z), depth.z, depth.w);
}
