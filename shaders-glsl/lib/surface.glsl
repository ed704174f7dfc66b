// What a pixel gets of a surfel: the vectors that the targets sum, see lib/sums.glsl.

#include "lib/shading.glsl"
#include "lib/colour_streams.glsl"

layout(constant_id = 20) const bool SHADE_SPLATS = false; // what is summed as colour is light: splats are lit at their centres

layout(set = 0, binding = 2, std430) readonly buffer Positions { float positions[]; };
layout(set = 0, binding = 3, std430) readonly buffer Normals { float normals[]; };
layout(set = 0, binding = 5, std430) readonly buffer Colours { uint colours[]; };

DEFINE_COLOURS(colour_of, COLOURS, colours)
DEFINE_COORDINATES(coordinates_of, colours)

// Unit vector from surfel i to the eye.
vec3 to_eye_of(uint i) {
    vec3 position = vec3(positions[3 * i], positions[3 * i + 1], positions[3 * i + 2]);
    return PERSPECTIVE ? normalize(frame.eye_hi.xyz - position + frame.eye_lo.xyz) : -frame.forward_hi.xyz;
}

// What the two targets sum of surfel i; `epsilon` tells its side.
void surface_of(uint i, float epsilon, out vec3 first, out vec3 second) {
    vec3 normal = sign(epsilon) * vec3(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
    second = SUM_COLOURS ? colour_of(i) : vec3(0.0);
    if (SHADE_SPLATS) second = lit(FRAME_SHINE, second, normal, to_eye_of(i));
    first = SUM_NORMALS ? normal : second;
}
