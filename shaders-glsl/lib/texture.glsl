// The texture: a picture with coarser copies of itself, each of half the side.

#include "lib/colour_streams.glsl"

layout(constant_id = 36) const uint TEXELS = 0; // their kind, as of colours

// Width and height of the finest level, number of levels; texels of all levels, fine to coarse, each row by row from the top left.
layout(set = 0, binding = 17, std430) readonly buffer Texture { uint width; uint height; uint levels; uint texels[]; } image_of;

DEFINE_COLOURS(texel, TEXELS, image_of.texels, 0, colour_words(TEXELS))

ivec2 texture_size(uint level) {
    return max(ivec2(image_of.width, image_of.height) >> level, 1);
}

// Between the four texels about coordinates, u to the right and v upwards; the picture is repeated.
vec3 bilinear(vec2 at, uint level) {
    uint start = 0;
    for (uint l = 0; l < level; l++) start += uint(texture_size(l).x * texture_size(l).y);
    ivec2 size = texture_size(level);
    // What is no number is somewhere, too.
    at = clamp(at - floor(at), 0.0, 1.0);
    vec2 place = vec2(at.x, 1.0 - at.y) * vec2(size) - 0.5;
    vec2 part = fract(place);
    // Whole numbers from -1 on.
    ivec2 low = (ivec2(floor(place)) + size) % size, high = (low + 1) % size;
    vec3 above = mix(texel(start + uint(low.y * size.x + low.x)), texel(start + uint(low.y * size.x + high.x)), part.x);
    vec3 below = mix(texel(start + uint(high.y * size.x + low.x)), texel(start + uint(high.y * size.x + high.x)), part.x);
    return mix(above, below, part.y);
}

// By how much coordinates change from a pixel to the next, from the neighbours either side that are of its surface, or the one that is; 0 if
// none is.
vec2 texture_step(ivec2 at, ivec2 step, Sample own) {
    vec2 sum = vec2(0.0);
    float count = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 place = at + side * step;
        if (!is_within(0, place)) continue;
        Sample other = load_final(place_in(0, 0, place));
        bool one = other.near > 0.0 && other.near <= own.far && own.near <= other.far && other.tube == own.tube;
        if (!one) continue;
        sum += float(side) * turn_from(other, own);
        count += 1.0;
    }
    return count > 0.0 ? sum / count : sum;
}

// The colour of a pixel that has a sample, from the level whose texels are as large as the pixel (Williams, Pyramidal Parametrics, 1983).
vec3 texture_at(ivec2 at, Sample own) {
    vec2 size = vec2(texture_size(0));
    vec2 x = size * texture_step(at, ivec2(1, 0), own), y = size * texture_step(at, ivec2(0, 1), own);
    float texels2 = max(dot(x, x), dot(y, y));
    float level = texels2 > 1.0 ? min(0.5 * log2(texels2), float(image_of.levels - 1)) : 0.0;
    uint finer = uint(level);
    vec3 colour = bilinear(own.coordinates, finer);
    float part = level - float(finer);
    return part > 0.0 ? mix(colour, bilinear(own.coordinates, finer + 1), part) : colour;
}
