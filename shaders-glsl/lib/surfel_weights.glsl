// Normalization weights of surfels.

#include "lib/weights.glsl"

layout(set = 0, binding = 11, std430) readonly buffer Weights { uint weights[]; }; // floats, or AT_CORNERS and an index

// Flag of a word that is an index, not a float: there four weights, the square's first axis and the disc's aspect follow each other.
const uint AT_CORNERS = 0x80000000u;

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
