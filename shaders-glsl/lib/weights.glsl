// Normalization weights: factors of surfels' kernels that replace the division by Σw (ren2002 §7, equation 17).

#ifndef LIB_WEIGHTS
#define LIB_WEIGHTS

layout(constant_id = 26) const bool WEIGHTS = false; // the scene has weights, and the frame uses them
layout(constant_id = 27) const bool CORNERS = false; // some surfels have one weight per corner of the square around their discs

// Bilinear weight between the corners −u −v, +u −v, −u +v, +u +v, at the kernel coordinates m, σ.
float bilinear_weight(vec4 corners, mat2 square, vec2 m) {
    vec2 at = clamp(0.5 + 0.5 / frame.cutoff * (square * m), 0.0, 1.0);
    vec2 along = mix(corners.xz, corners.yw, at.x);
    return mix(along.x, along.y, at.y);
}

#endif
