// Shade: the final level 0 → picture, normal, depth, number of the point, lit pixel by pixel (marroquim2008 §3.4).
#version 450
#pragma variant LOOKUPS
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/pyramid.glsl"
#include "lib/lens.glsl"
#include "lib/shading.glsl"
#include "lib/background.glsl"
#include "lib/lattice.glsl"

PYRAMID(2, final, readonly)
LOADED(final)

layout(constant_id = 25) const bool MATERIALS = false; // points shine in their own way

#ifdef LOOKUPS
#include "lib/texture.glsl"
#include "lib/materials.glsl"
#endif

layout(constant_id = 9) const bool OUT_NORMAL = false;
layout(constant_id = 10) const bool OUT_DEPTH = false;
layout(constant_id = 35) const bool OUT_ID = false;

layout(set = 1, binding = 3, std430) writeonly buffer Picture { uint picture[]; }; // bits: colour, then normals, then depths, then numbers

layout(constant_id = 31) const bool COVERAGE = false; // α is the part of a pixel that is covered, not whether its centre is

// What a disc's variance is widened by, px²: what push widens it by for pixels, at half their side. Narrower discs leave holes between
// themselves; wider ones reach beyond the outline.
const float SOLID = 0.0625;

// The samples of a pixel that are within the disc with this centre, px, and e px from the pixel's.
uint covered_by(Sample s, vec2 centre, vec2 e) {
    uint mask = 0;
    for (uint k = 0; k < SAMPLES; k++) mask |= uint(radii2(s, centre, sample_at(k) - e, SOLID) <= 1.0) << k;
    return mask;
}

// The part of a pixel that is covered, where it has a disc: the samples within any disc of the pixels next to it, hidden ones too, and at
// least one. All of it, unless a neighbour is empty.
float coverage_of(ivec2 at) {
    uint mask = 0;
    bool inner = true;
    for (int k = 0; k < 9; k++) {
        ivec2 place = at + ivec2(k % 3, k / 3) - 1;
        if (is_within(0, place)) inner = inner && load_final(place_in(0, 0, place)).near > 0.0;
    }
    if (inner) return 1.0;
    for (int k = 0; k < 9; k++) {
        ivec2 place = at + ivec2(k % 3, k / 3) - 1;
        if (!is_within(0, place)) continue;
        Sample s = load_final(place_in(0, 0, place));
        vec2 e = vec2(place - at) + s.displacement;
        if (s.near > 0.0) mask |= covered_by(s, level_centre(0, at) + e, e);
    }
    return max(bitCount(mask), 1) / float(SAMPLES);
}

void main() {
    ivec2 at = own_pixel(0);
    if (at.x < 0) return;
    uvec2 size = uvec2(frame.viewport);
    uint pixels = size.x * size.y, i = uint(at.y) * size.x + uint(at.x);
    Sample s = load_final(i);
    vec4 image = frame.background;
    if (s.near > 0.0) {
        vec2 centre = vec2(at) + 0.5;
        vec3 ray = centre.x * view.ray_hi[0].xyz + centre.y * view.ray_hi[1].xyz + view.ray_hi[2].xyz;
        vec3 to_eye = PERSPECTIVE ? -normalize(ray) : -view.forward_hi.xyz;
        vec3 colour = SUM_COLOURS ? s.colour : frame.albedo.rgb;
        Shine shine = FRAME_SHINE;
#ifdef LOOKUPS
        if (TEXTURE) colour = texture_at(at, s);
        if (MATERIALS) shine = shine_of(s.id);
#endif
        vec3 tangent = s.normal;
        if (s.tube && PAPER) s.normal = line_normal(tangent, to_eye);
        else if (s.tube) s.depth = on_tube(s, centre, -s.displacement, s.normal);
        // A pixel shows one point, or what is made of those about it.
        vec3 shown = vec3(1.0);
        if (SHADING == LIT) {
            shown = s.tube && PAPER ? lit_line(shine, colour, tangent, to_eye) : lit(shine, colour, s.normal, to_eye);
        }
        if (SHADING == COLOUR) shown = colour;
        if (SHADING == NORMAL) shown = s.normal;
        if (SHADING == DEPTH) shown = vec3(s.depth);
        image = over_background(shown, COVERAGE ? coverage_of(at) : 1.0);
    }
    for (uint k = 0; k < 4; k++) picture[4 * i + k] = floatBitsToUint(image[k]);
    if (OUT_NORMAL) for (uint k = 0; k < 3; k++) picture[4 * pixels + 3 * i + k] = floatBitsToUint(s.normal[k]);
    if (OUT_DEPTH) picture[(OUT_NORMAL ? 7 : 4) * pixels + i] = floatBitsToUint(s.depth);
    if (OUT_ID) picture[((OUT_NORMAL ? 7 : 4) + (OUT_DEPTH ? 1 : 0)) * pixels + i] = s.id;
}

#endif
