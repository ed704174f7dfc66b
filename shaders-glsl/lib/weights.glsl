// Normalization weights: what the kernels of surfels are multiplied by where nothing is divided (ren2002 §7, equation 17).

layout(constant_id = 26) const bool WEIGHTS = false; // there are some, and the frame wants them
layout(constant_id = 27) const bool CORNERS = false; // some surfels have one at each corner of the square about their discs

#ifndef FRAGMENT

layout(set = 0, binding = 11, std430) readonly buffer Weights { uint weights[]; }; // floats; of corners, where they are

// Set in what is not a float but the index at which four weights, the square's first axis and the disc's aspect follow each other.
const uint AT_CORNERS = 0x80000000u;

// Whether rows of the frame's map to pixels keep the handedness of the world, seen along the view: 1 or −1.
float handedness() {
    return sign(dot(cross(view.rows_hi[0].xyz, view.rows_hi[1].xyz), view.forward_hi.xyz));
}

// The rotation from a kernel's axes on the screen to those of the surfel's square. Both kernels are circles in their own units, so that it is
// one even where the filter has widened the splat, or where that is seen edge-on: only the image of the longer axis is looked at.
// All vectors are the world's; `to_eye` runs from the surfel's centre.
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

// A weight that is bilinear between those at the corners −u −v, +u −v, −u +v, +u +v, at the place m, σ, in the kernel.
float weight_in(vec4 corners, mat2 square, vec2 m) {
    vec2 at = clamp(0.5 + 0.5 / frame.cutoff * (square * m), 0.0, 1.0);
    vec2 along = mix(corners.xz, corners.yw, at.x);
    return mix(along.x, along.y, at.y);
}
