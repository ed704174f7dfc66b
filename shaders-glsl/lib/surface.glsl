// What a pixel gets of a surfel: the vectors that the targets sum, see lib/sums.glsl.

#include "lib/shading.glsl"
#include "lib/surfels.glsl"

layout(constant_id = 20) const bool SHADE_SPLATS = false; // what is summed as colour is light: splats are lit at their centres

DEFINE_COLOURS(colour_of, COLOURS, colours, COLOUR_OFFSET, COLOUR_STRIDE)
DEFINE_COORDINATES(coordinates_of, colours)

// Unit vector from surfel i to the eye.
vec3 to_eye_of(uint i) {
    return PERSPECTIVE ? normalize(view.eye_hi.xyz - position_of(i) + view.eye_lo.xyz) : -view.forward_hi.xyz;
}

// What the two targets sum of surfel i; `epsilon` tells its side.
void surface_of(uint i, float epsilon, out vec3 first, out vec3 second) {
    vec3 normal = sign(epsilon) * normal_of(i);
    second = SUM_COLOURS ? colour_of(i) : vec3(0.0);
    if (SHADE_SPLATS) second = lit(FRAME_SHINE, second, normal, to_eye_of(i));
    first = SUM_NORMALS ? in_world(normal) : second;
}
