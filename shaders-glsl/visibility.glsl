// Visibility: the depth of the nearest surface, moved back by ε along the viewing rays (zwicker2004 §6, first pass).
#version 450
#extension GL_GOOGLE_include_directive : require

#include "lib/frame.glsl"
#define SPLAT_ACCESS readonly
#include "lib/splat.glsl"
#include "lib/draw_splat.glsl"

#ifdef VERTEX

void main() {
    place_splat(splats[gl_VertexIndex / 3], frame.visibility_lowpass, gl_VertexIndex % 3);
}

#endif
#ifdef FRAGMENT

void main() {
    float key;
    splat_fragment(key);
    // Moving a plane away along the rays by the factor 1 + ε/z divides κ by it. Never 0, which means that nothing is there.
    gl_FragDepth = PERSPECTIVE ? key * depth_plane.w : max(key - depth_plane.w, 1e-6);
}

#endif
