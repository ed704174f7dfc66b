// Seed: the depth of a host's surfaces, moved back so far that no splat behind it can be seen, as what visibility starts from
// (src/embed/native.rs).
#version 450
#pragma variant MULTISAMPLED FRAGMENT
#extension GL_GOOGLE_include_directive : require

#ifdef VERTEX
#include "lib/full_screen.glsl"
#endif
#ifdef FRAGMENT

layout(constant_id = 0) const bool PERSPECTIVE = true;
layout(constant_id = 43) const uint HOST_SAMPLES = 1;

layout(push_constant) uniform Seed {
    vec2 key;         // κ of the host's depth d is key.x d + key.y
    float resolution; // what two depths of the host's may differ by and be the same, and what rounding does to them, as κ
    float rounding;   // what sums of κ may be off, relative
    float behind;     // how far ε reaches at most: perspective: over the distance of the near plane; orthographic: as a difference of κ
} seed;

#ifdef MULTISAMPLED
layout(set = 1, binding = 15, input_attachment_index = 0) uniform subpassInputMS host_depth;
#else
layout(set = 1, binding = 15, input_attachment_index = 0) uniform subpassInput host_depth;
#endif

// κ of the host's surface, at most.
float key_at(float depth) {
    return (seed.key.x * depth + seed.key.y - seed.resolution) * (1.0 - seed.rounding);
}

// What is visible at any sample is visible.
float farthest() {
#ifdef MULTISAMPLED
    float key = key_at(subpassLoad(host_depth, 0).r);
    for (int k = 1; k < int(HOST_SAMPLES); k++) key = min(key, key_at(subpassLoad(host_depth, k).r));
    return key;
#else
    return key_at(subpassLoad(host_depth).r);
#endif
}

void main() {
    float key = clamp(farthest(), 0.0, 1.0);
    gl_FragDepth = PERSPECTIVE ? key / (1.0 + seed.behind * key) : max(key - seed.behind, 0.0);
}

#endif
