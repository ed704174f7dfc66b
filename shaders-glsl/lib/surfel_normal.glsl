// Normals of surfels, and their directions to the eye, in the axes of the scene.

#ifndef LIB_SURFEL_NORMAL
#define LIB_SURFEL_NORMAL

#include "lib/surfels.glsl"

// Unit vector from surfel i to the eye.
vec3 to_eye_of(uint i) {
    return PERSPECTIVE ? normalize(view.eye_hi.xyz - position_of(i) + view.eye_lo.xyz) : -view.forward_hi.xyz;
}

// Unit normal.
vec3 normal_of(uint i) {
    if (is_billboard(i)) return to_eye_of(i);
    vec3 normal = stored_normal(i);
    return NORMALS == FLOAT_NORMALS ? normal : normalize(normal);
}

#endif
