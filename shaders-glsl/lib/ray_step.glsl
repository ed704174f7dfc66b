// Rays of pixels, in the axes of the view.

// Step of the ray through a screen position per unit of distance.
vec3 ray_step(vec2 at) {
    if (!PERSPECTIVE) return view.forward_hi.xyz;
    return (at.x * view.ray_hi[0].xyz + at.y * view.ray_hi[1].xyz + view.ray_hi[2].xyz) / view.near;
}
