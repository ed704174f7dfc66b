// Projection of a position to the screen, in twice the precision: see lib/double_float.glsl.

// Row i of the homogeneous pixel of a position relative to the eye.
vec2 pixel_row(int i, vec3 hi, vec3 lo) {
    vec2 at_eye = PERSPECTIVE ? vec2(0.0) : vec2(view.rows_hi[i].w, view.rows_lo[i].w);
    return add(dot_double(hi, lo, view.rows_hi[i].xyz, view.rows_lo[i].xyz), at_eye);
}

// Distance of the plane through a position that is parallel to the image plane, from its distance from the eye.
vec2 counted_distance(vec2 from_eye) {
    return DISTANT ? add(from_eye, vec2(view.forward_hi.w, view.forward_lo.w)) : from_eye;
}
