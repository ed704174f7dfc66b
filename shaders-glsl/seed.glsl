// Seed: initializes visibility with the depth of the host's surfaces, moved back by the largest ε, so that it occludes only hidden splats
// (src/embed/native/seeding.rs).
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
    vec2 key;         // maps the host's depth d to κ = key.x d + key.y
    float key_offset; // perspective: near / z − κ
    float resolution; // resolution of the host's depth and its rounding error, as κ
    float rounding;   // relative rounding error of sums of κ
    float behind;     // largest ε: perspective: over the distance of the near plane; orthographic: as a difference of κ
} seed;

#ifdef MULTISAMPLED
layout(set = 1, binding = 15, input_attachment_index = 0) uniform subpassInputMS host_depth;
#else
layout(set = 1, binding = 15, input_attachment_index = 0) uniform subpassInput host_depth;
#endif

// Lower bound of the κ of the host's surface.
float key_at(float depth) {
    return (seed.key.x * depth + seed.key.y - seed.resolution) * (1.0 - seed.rounding);
}

// A splat is visible if any sample shows it.
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
    float key = clamp(farthest(), 0.0, 1.0), part = seed.behind * (key + seed.key_offset);
    gl_FragDepth = max(PERSPECTIVE ? (key - seed.key_offset * part) / (1.0 + part) : key - seed.behind, 0.0);
}

#endif
