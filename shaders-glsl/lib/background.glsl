// What the picture shows, before what there may be behind it.

layout(constant_id = 6) const uint SHADING = 0;
const uint LIT = 0, COLOUR = 1, NORMAL = 2, DEPTH = 3, OVERLAPS = 4, WEIGHT = 5;

// What is shown of a surface with the background, if there is one, behind it.
vec4 over_background(vec3 shown, float alpha) {
    if (frame.background.a == 0.0) return vec4(shown, alpha);
    // Numbers are not mixed with a colour: the half decides.
    if (SHADING != LIT && SHADING != COLOUR) alpha = step(0.5, alpha);
    return vec4(mix(frame.background.rgb, shown, alpha), 1.0);
}
