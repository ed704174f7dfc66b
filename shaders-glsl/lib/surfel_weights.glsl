// Normalization weights of surfels.

#include "lib/square.glsl"
#include "lib/weights.glsl"

layout(set = 0, binding = 11, std430) readonly buffer Weights { uint weights[]; }; // floats, or AT_CORNERS and an index

// Flag of a word that is an index, not a float: there four weights, the square's first axis and the disc's aspect follow each other.
const uint AT_CORNERS = 0x80000000u;

// Normalization weight of surfel i, and its weights at the corners of the surfel's square.
float surfel_weight(uint i, Splat splat, out vec4 corners, out mat2 square) {
    corners = vec4(1.0);
    square = mat2(1.0);
    if (OVERLAP) return 1.0;
    uint weight = WEIGHTS ? weights[i] : floatBitsToUint(1.0);
    if (!CORNERS || (weight & AT_CORNERS) == 0) return uintBitsToFloat(weight);
    float at[8];
    for (uint k = 0; k < 8; k++) at[k] = uintBitsToFloat(weights[(weight & ~AT_CORNERS) + k]);
    corners = vec4(at[0], at[1], at[2], at[3]);
    vec3 to_eye = view.eye_hi.xyz - position_of(i) + view.eye_lo.xyz;
    square = square_of(splat, vec3(at[4], at[5], at[6]), at[7], normal_of(i), to_eye);
    return 1.0;
}
