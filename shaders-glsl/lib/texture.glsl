// Texture: an image with mip levels.

#include "lib/colour_streams.glsl"

layout(constant_id = 36) const uint TEXELS = 0; // format of texels, as of colours

// Width and height of level 0, number of levels; texels of all levels, fine to coarse, row by row from the top left.
layout(set = 0, binding = 17, std430) readonly buffer Texture { uint width; uint height; uint levels; uint texels[]; } texture_image;

DEFINE_COLOURS(texel, TEXELS, texture_image.texels, 0, colour_words(TEXELS))

ivec2 texture_size(uint level) {
    return max(ivec2(texture_image.width, texture_image.height) >> level, 1);
}

// Bilinear filter at texture coordinates, u to the right and v upwards; addressing repeats.
vec3 bilinear(vec2 at, uint level) {
    uint start = 0;
    for (uint l = 0; l < level; l++) start += uint(texture_size(l).x * texture_size(l).y);
    ivec2 size = texture_size(level);
    // NaN becomes a valid coordinate.
    at = clamp(at - floor(at), 0.0, 1.0);
    vec2 position = vec2(at.x, 1.0 - at.y) * vec2(size) - 0.5;
    vec2 part = fract(position);
    // From -1 on.
    ivec2 low = (ivec2(floor(position)) + size) % size, high = (low + 1) % size;
    vec3 above = mix(texel(start + uint(low.y * size.x + low.x)), texel(start + uint(low.y * size.x + high.x)), part.x);
    vec3 below = mix(texel(start + uint(high.y * size.x + low.x)), texel(start + uint(high.y * size.x + high.x)), part.x);
    return mix(above, below, part.y);
}

// Derivative of texture coordinates per pixel, from the neighbours on both sides that are of the same surface, or the one that is; 0 if
// none is.
vec2 texture_step(ivec2 at, ivec2 step, Sample centre) {
    vec2 sum = vec2(0.0);
    float count = 0.0;
    for (int side = -1; side <= 1; side += 2) {
        ivec2 position = at + side * step;
        if (!is_within(picture_size(), position)) continue;
        Sample other = load_final(position);
        bool same_surface = other.near > 0.0 && other.near <= centre.far && centre.near <= other.far && other.tube == centre.tube;
        if (!same_surface) continue;
        sum += float(side) * coordinate_offset(other, centre);
        count += 1.0;
    }
    return count > 0.0 ? sum / count : sum;
}

// Filtered colour of a pixel, from the level whose texels match the pixel's size (Williams, Pyramidal Parametrics, 1983), trilinear.
vec3 texture_colour(ivec2 at, Sample centre) {
    vec2 size = vec2(texture_size(0));
    vec2 x = size * texture_step(at, ivec2(1, 0), centre), y = size * texture_step(at, ivec2(0, 1), centre);
    float texels2 = max(dot(x, x), dot(y, y));
    float level = texels2 > 1.0 ? min(0.5 * log2(texels2), float(texture_image.levels - 1)) : 0.0;
    uint finer = uint(level);
    vec3 colour = bilinear(centre.coordinates, finer);
    float part = level - float(finer);
    return part > 0.0 ? mix(colour, bilinear(centre.coordinates, finer + 1), part) : colour;
}
