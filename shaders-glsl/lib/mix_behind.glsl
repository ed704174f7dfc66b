// Mixes the surface behind, by its sums, into a pixel of the picture, whose nearest surface has some of the covered samples.
void mix_behind(ivec2 pixel, uint covered, uint nearest, vec4 s0, vec4 s1) {
    if (SUM_WEIGHTS && !(s0.x > 0.0)) return;
    float samples = bitCount(covered), share = bitCount(nearest) / samples;
    vec4 behind = normalize_pixel(vec2(pixel) + 0.5, true, samples / 16.0, s0, s1).image;
    imageStore(image_output, pixel, mix(behind, imageLoad(image_output, pixel), share));
}
