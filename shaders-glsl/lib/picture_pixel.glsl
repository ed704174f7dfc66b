// Output of a pixel from visibility and sums (zwicker2004 §6, third pass; equation 2's normalization).

#include "lib/sums.glsl"
#include "lib/shading.glsl"
#include "lib/background.glsl"

#include "lib/shade.glsl"

struct Pixel {
    vec4 image;
    vec3 normal;
    float depth;
};

// Normalizes and shades the pixel at `centre` (px), of which `alpha` is covered.
Pixel normalize_pixel(vec2 centre, bool visible, float alpha, vec4 s0, vec4 s1) {
    // Only where visibility wrote: the attribute footprint is wider and would widen the outline.
    if (!visible || alpha == 0.0 || SUM_WEIGHTS && !(s0.x > 0.0)) return Pixel(empty_pixel(), vec3(0.0), 0.0);

    float total = NORMALIZATION == PER_PIXEL ? s0.x : 1.0;
    vec3 ray = centre.x * view.ray_hi[0].xyz + centre.y * view.ray_hi[1].xyz + view.ray_hi[2].xyz;
    vec3 to_eye = PERSPECTIVE ? -normalize(ray) : -view.forward_hi.xyz;
    vec3 normal = vec3(0.0), mean = vec3(0.0);
    if (SUM_NORMALS) {
        mean = s0.yzw / s0.x;
        // Opposite normals cancel. The squares of the sums themselves would underflow for splats far below a pixel.
        normal = length(mean) < 1e-6 ? to_eye : normalize(mean);
    }
    vec3 colour = frame.albedo.rgb;
    if (SUM_COLOURS) colour = (SUM_NORMALS ? s1.yzw : s0.yzw) / total;
    float depth = 0.0;
    if (SUM_DEPTH) {
        float key = s1.x / (s0.x * frame.key_gain);
        depth = PERSPECTIVE ? view.near / inverse_depth(key) : view.distance_offset + (view.near + (1.0 - key) / view.key_slope);
    }

    vec3 shaded;
    if (SHADING == LIT) {
        shaded = SHADE == PER_SPLAT ? colour : lit(FRAME_SHINE, colour, normal, SHADE == BY_MEAN_NORMAL ? mean : normal, to_eye);
    }
    if (SHADING == COLOUR) shaded = colour;
    if (SHADING == NORMAL) shaded = normal;
    if (SHADING == DEPTH) shaded = vec3(depth);
    if (SHADING == OVERLAPS || SHADING == WEIGHT) shaded = vec3(s0.x);
    return Pixel(picture_pixel(shaded, alpha), normal, depth);
}

#ifdef COMPUTE

#include "lib/output_images.glsl"

void store_pixel(ivec2 coordinates, Pixel pixel) {
    store_outputs(coordinates, pixel.image, pixel.normal, pixel.depth);
}

#endif
