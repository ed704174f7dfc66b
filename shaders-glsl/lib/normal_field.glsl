// Linear normal fields: the normal of a splat varies over its disc by the curvature of the surface (Botsch, Spernat and Kobbelt 2004, *Phong
// Splatting*).

#ifndef LIB_NORMAL_FIELD
#define LIB_NORMAL_FIELD

#include "lib/tangents.glsl"

layout(constant_id = 83) const bool FRAME_NORMAL_FIELDS = false; // the frame sums normals of fields: some scene has curvatures

// A field as it is stored: in the tangent plane of the stored normal.
vec4 stored_field(vec3 normal, mat2x3 field) {
    mat2 in_plane = transpose(tangents(normal)) * field;
    return vec4(in_plane[0], in_plane[1]);
}

mat2x3 field_of(vec3 normal, vec4 stored) {
    return tangents(normal) * mat2(stored.xy, stored.zw);
}

// Normal of a field at the kernel coordinates m, σ; `field` is orthogonal to the unit normal.
vec3 normal_at(vec3 normal, mat2x3 field, vec2 m) {
    vec3 turn = field * m;
    return (normal + turn) * inversesqrt(1.0 + dot(turn, turn));
}

#endif
