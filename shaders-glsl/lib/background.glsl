// Outputs: the quantity that the picture shows, and its blend with the background.

layout(constant_id = 6) const uint SHADING = 0;
const uint LIT = 0, COLOUR = 1, NORMAL = 2, DEPTH = 3, OVERLAPS = 4, WEIGHT = 5;

// Radius of the filter of pixels after shading, px; 0: none.
layout(constant_id = 66) const uint FILTER_RADIUS = 0;

// Whether a pass after shading blends with the background.
layout(constant_id = 76) const bool LATE_BACKGROUND = false;

// Blends a shaded value over the background, if the frame has one.
vec4 over_background(vec3 shaded, float alpha) {
    if (frame.background.a == 0.0) return vec4(shaded, alpha);
    return vec4(mix(frame.background.rgb, shaded, alpha), 1.0);
}

// A pixel of the picture, of which `alpha` is covered.
vec4 picture_pixel(vec3 shaded, float alpha) {
    return LATE_BACKGROUND ? vec4(shaded, alpha) : over_background(shaded, alpha);
}

// A pixel without a surface.
vec4 empty_pixel() {
    return LATE_BACKGROUND ? vec4(0.0) : frame.background;
}
