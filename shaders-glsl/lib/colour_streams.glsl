// Colours as a scene holds them: 8 bits of sRGB a channel in a word, three linear floats, or, with a texture, coordinates in it and for those
// who do not look there the linear colour.

const uint COLOURS_NONE = 0, COLOURS_SRGB8 = 1, COLOURS_LINEAR = 2, COLOURS_TEXTURED = 3;

vec3 srgb_to_linear(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// NAME(i): colour i, linear, of a stream of this KIND in WORDS.
#define DEFINE_COLOURS(NAME, KIND, WORDS)                                                  \
    vec3 NAME(uint i) {                                                                    \
        if (KIND == COLOURS_NONE) return frame.albedo.rgb;                                 \
        if (KIND == COLOURS_SRGB8) return srgb_to_linear(unpackUnorm4x8(WORDS[i]).rgb);    \
        uint k = KIND == COLOURS_LINEAR ? 3 * i : 5 * i + 2;                               \
        return uintBitsToFloat(uvec3(WORDS[k], WORDS[k + 1], WORDS[k + 2]));               \
    }

// NAME(i): coordinates i in the texture, of such a stream.
#define DEFINE_COORDINATES(NAME, WORDS) \
    vec2 NAME(uint i) { return uintBitsToFloat(uvec2(WORDS[5 * i], WORDS[5 * i + 1])); }
