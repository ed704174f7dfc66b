// Outputs: the quantity that the picture shows, and its blend with the background.

layout(constant_id = 6) const uint SHADING = 0;
const uint LIT = 0, COLOUR = 1, NORMAL = 2, DEPTH = 3, OVERLAPS = 4, WEIGHT = 5;

// Blends a shaded value over the background, if the frame has one.
vec4 over_background(vec3 shaded, float alpha) {
    if (frame.background.a == 0.0) return vec4(shaded, alpha);
    // Scalars are not blended with a colour: α is rounded.
    if (SHADING != LIT && SHADING != COLOUR) alpha = step(0.5, alpha);
    return vec4(mix(frame.background.rgb, shaded, alpha), 1.0);
}
