// Normalization weights: what the kernels of surfels are multiplied by where nothing is divided (ren2002 §7, equation 17).

#ifndef LIB_WEIGHTS
#define LIB_WEIGHTS

layout(constant_id = 26) const bool WEIGHTS = false; // there are some, and the frame wants them
layout(constant_id = 27) const bool CORNERS = false; // some surfels have one at each corner of the square about their discs

// A weight that is bilinear between those at the corners −u −v, +u −v, −u +v, +u +v, at the place m, σ, in the kernel.
float weight_in(vec4 corners, mat2 square, vec2 m) {
    vec2 at = clamp(0.5 + 0.5 / frame.cutoff * (square * m), 0.0, 1.0);
    vec2 along = mix(corners.xz, corners.yw, at.x);
    return mix(along.x, along.y, at.y);
}

#endif
