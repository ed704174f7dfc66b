// Attributes of a surfel: the vectors that targets sum, see lib/sums.glsl.

#include "lib/shading.glsl"
#include "lib/surfel_normal.glsl"

#include "lib/shade.glsl"

DEFINE_COLOURS(colour_of, COLOURS, colours, COLOUR_OFFSET, COLOUR_STRIDE)
DEFINE_COORDINATES(coordinates_of, colours)

// Attributes that the two targets sum of surfel i; the sign of `epsilon` selects the visible side.
void surfel_attributes(uint i, float epsilon, out vec3 attribute0, out vec3 attribute1) {
    vec3 normal = sign(epsilon) * normal_of(i);
    attribute1 = SUM_COLOURS ? colour_of(i) : vec3(0.0);
    if (SHADE == PER_SPLAT) attribute1 = lit(FRAME_SHINE, attribute1, normal, normal, to_eye_of(i));
    attribute0 = SUM_NORMALS ? to_world(normal) : attribute1;
}
