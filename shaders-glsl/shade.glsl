// Shade: the final level 0 → picture, normal, depth, lit pixel by pixel (marroquim2008 §3.4).
#version 450
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pyramid.glsl"
#include "lib/lens.glsl"
#include "lib/shading.glsl"

DEFINE_PYRAMID(1, from)

layout(constant_id = 6) const uint SHADING = 0;
const uint LIT = 0, COLOUR = 1, NORMAL = 2, DEPTH = 3;
layout(constant_id = 9) const bool OUT_NORMAL = false;
layout(constant_id = 10) const bool OUT_DEPTH = false;

layout(set = 2, binding = 0, std430) writeonly buffer Picture { float picture[]; }; // colour, then normals, then depths

void main() {
    ivec2 at = own_pixel(0);
    if (at.x < 0) return;
    uvec2 size = uvec2(frame.viewport);
    uint pixels = size.x * size.y, i = uint(at.y) * size.x + uint(at.x);
    Sample s = load_from(i);
    vec4 image = frame.background;
    if (s.near > 0.0) {
        vec2 centre = vec2(at) + 0.5;
        vec3 ray = centre.x * frame.ray_hi[0].xyz + centre.y * frame.ray_hi[1].xyz + frame.ray_hi[2].xyz;
        vec3 to_eye = PERSPECTIVE ? -normalize(ray) : -frame.forward_hi.xyz;
        vec3 colour = SUM_COLOURS ? s.colour : frame.albedo.rgb;
        vec3 tangent = s.normal;
        if (s.tube && PAPER) s.normal = line_normal(tangent, to_eye);
        else if (s.tube) s.depth = on_tube(s, centre, -s.displacement, s.normal);
        // A pixel shows one point, or what is made of those about it.
        vec3 shown = vec3(1.0);
        if (SHADING == LIT) shown = s.tube && PAPER ? lit_line(colour, tangent, to_eye) : lit(colour, s.normal, to_eye);
        if (SHADING == COLOUR) shown = colour;
        if (SHADING == NORMAL) shown = s.normal;
        if (SHADING == DEPTH) shown = vec3(s.depth);
        image = vec4(shown, 1.0);
    }
    for (uint k = 0; k < 4; k++) picture[4 * i + k] = image[k];
    if (OUT_NORMAL) for (uint k = 0; k < 3; k++) picture[4 * pixels + 3 * i + k] = s.normal[k];
    if (OUT_DEPTH) picture[(OUT_NORMAL ? 7 : 4) * pixels + i] = s.depth;
}

#endif
