// Squares around discs: their image in a splat's kernel.

#ifndef LIB_SQUARE
#define LIB_SQUARE

// 1 if the projection to pixels keeps the handedness of the world, seen along the view, else −1.
float handedness() {
    return sign(dot(cross(view.rows_hi[0].xyz, view.rows_hi[1].xyz), view.forward_hi.xyz));
}

// Rotation from a kernel's axes on the screen to those of the surfel's square. Both kernels are circles in their own units, so it is a
// rotation even if the filter widens the splat or the splat is edge-on: it follows from the projected major axis. All vectors are in world
// space; `to_eye` starts at the surfel's centre.
mat2 square_of(Splat splat, vec3 u, float aspect, vec3 normal, vec3 to_eye) {
    vec3 v = aspect * cross(normal, u);
    mat3 rows = transpose(mat3(view.rows_hi[0].xyz, view.rows_hi[1].xyz, view.rows_hi[2].xyz));
    vec3 centre = PERSPECTIVE ? rows * -to_eye : vec3(0.0, 0.0, 1.0);
    vec3 U = rows * u, V = rows * v;
    vec2 across = vec2(dot(splat.axis, U.xy), dot(splat.axis, V.xy)) - dot(splat.axis, centre.xy) / centre.z * vec2(U.z, V.z);
    vec2 first = length(across) > 0.0 ? normalize(across) : vec2(1.0, 0.0);
    float side = -sign(splat.epsilon) * handedness();
    return mat2(first, side * vec2(-first.y, first.x));
}

#endif
