// Colours as a scene holds them: see lib/sums.glsl for the kinds.

vec3 srgb_to_linear(vec3 c) {
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// NAME(i): colour i, linear, of a stream of this KIND in WORDS.
#define DEFINE_COLOURS(NAME, KIND, WORDS)                                                                              \
    vec3 NAME(uint i) {                                                                                                \
        if (KIND == COLOURS_NONE) return frame.albedo.rgb;                                                             \
        if (KIND == COLOURS_LINEAR) return uintBitsToFloat(uvec3(WORDS[3 * i], WORDS[3 * i + 1], WORDS[3 * i + 2]));   \
        return srgb_to_linear(unpackUnorm4x8(WORDS[i]).rgb);                                                           \
    }
