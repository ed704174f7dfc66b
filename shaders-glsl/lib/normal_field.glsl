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

// Normals of a field on a tile, not of unit length: at the tile's first pixel, and their change per px along x and y. u and v are the rows of the
// affine map from pixels of the tile to kernel coordinates, σ. Far from a thin splat these are huge: they are clamped, so that no sum of normals
// overflows.
mat3 normals_on_tile(vec3 normal, mat2x3 field, vec3 u, vec3 v) {
    mat3 normals = field * transpose(mat2x3(u, v));
    normals[0] += normal;
    for (int k = 0; k < 3; k++) normals[k] = clamp(normals[k], -1e30, 1e30);
    return normals;
}

#endif
