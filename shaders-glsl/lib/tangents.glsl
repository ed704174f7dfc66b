// Bases of tangent planes.

#ifndef LIB_TANGENTS
#define LIB_TANGENTS

// Two unit vectors that complete n to a right-handed basis (Duff et al. 2017).
mat2x3 tangents(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float a = -1.0 / (s + n.z);
    float b = n.x * n.y * a;
    return mat2x3(vec3(1.0 + s * n.x * n.x * a, s * b, -s * n.x), vec3(b, s + n.y * n.y * a, -n.y));
}

// Axes of an elliptical disc whose longer semi-axis is 1. They are orthogonal to n even if the stored shape is rounded.
mat2x3 ellipse_axes(vec3 n, vec4 shape) {
    vec3 minor = normalize(cross(n, shape.xyz));
    return mat2x3(cross(minor, n), shape.w * minor);
}

#endif
