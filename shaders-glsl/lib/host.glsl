// What a host's targets want of a picture: colours over what is there, and the depth that the host's own surfaces have.

layout(constant_id = 40) const bool HOST_DEPTH = false; // the host's target has depth
layout(constant_id = 41) const bool ENCODE = false;     // the host's colours are sRGB-encoded by the shader that writes them

vec3 linear_to_srgb(vec3 c) {
    return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

// The colour `seen`, linear and α, as it is blended over the host's.
vec4 over_host(vec4 seen) {
    vec3 colour = ENCODE ? linear_to_srgb(clamp(seen.rgb, 0.0, 1.0)) : seen.rgb;
    return vec4(seen.a * colour, seen.a);
}

// The host's depth at distance z: depth.x + depth.y / z in perspective, depth.x + depth.y z otherwise; then its least and greatest.
float host_depth(vec4 depth, float z) {
    // A disc may be nearer at its rim than the near plane, by which its centre is cut off.
    return clamp(depth.x + depth.y * (PERSPECTIVE ? 1.0 / z : z), depth.z, depth.w);
}
