// Colour formats of scenes: 8 bits per channel in a word, sRGB or linear; three linear floats; linear half floats in two words; or with a
// texture, coordinates in it followed by the linear colour.

#include "lib/srgb.glsl"

const uint COLOURS_NONE = 0, COLOURS_SRGB8 = 1, COLOURS_LINEAR = 2, COLOURS_TEXTURED = 3, COLOURS_UNORM8 = 4, COLOURS_HALF = 5;

// Words per colour of a tightly packed stream.
uint colour_words(uint kind) {
    if (kind == COLOURS_LINEAR) return 3;
    if (kind == COLOURS_TEXTURED) return 5;
    return kind == COLOURS_HALF ? 2 : 1;
}

// NAME(i): colour i, linear, of a stream of this KIND in WORDS, which starts at OFFSET and is STRIDE words apart.
#define DEFINE_COLOURS(NAME, KIND, WORDS, OFFSET, STRIDE)                                                              \
    vec3 NAME(uint i) {                                                                                                \
        if (KIND == COLOURS_NONE) return frame.albedo.rgb;                                                             \
        uint k = OFFSET + STRIDE * i;                                                                                  \
        if (KIND == COLOURS_SRGB8) return srgb_to_linear(unpackUnorm4x8(WORDS[k]).rgb);                                \
        if (KIND == COLOURS_UNORM8) return unpackUnorm4x8(WORDS[k]).rgb;                                               \
        if (KIND == COLOURS_HALF) return vec3(unpackHalf2x16(WORDS[k]), unpackHalf2x16(WORDS[k + 1]).x);               \
        if (KIND == COLOURS_TEXTURED) k += 2;                                                                          \
        return uintBitsToFloat(uvec3(WORDS[k], WORDS[k + 1], WORDS[k + 2]));                                           \
    }

// NAME(i): texture coordinates i of such a stream.
#define DEFINE_COORDINATES(NAME, WORDS) \
    vec2 NAME(uint i) { return uintBitsToFloat(uvec2(WORDS[5 * i], WORDS[5 * i + 1])); }
