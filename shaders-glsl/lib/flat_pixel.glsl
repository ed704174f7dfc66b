// Parallel projection of a vector at distance 1, px.
vec2 flat_pixel(vec3 v) {
    return vec2(dot(view.flat_rows[0].xyz, v), dot(view.flat_rows[1].xyz, v));
}
