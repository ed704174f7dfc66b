// What every pass knows of the camera and of the settings; src/frame/uniforms.rs fills it, once a frame.
// World space here is relative to the scene's origin; for passes over a scene that is placed it is that scene's own space, with its own unit. κ, the depth key, is near / z in perspective and linear in z otherwise:
// 1 at the near plane, falling with distance, and affine on the screen for every plane.

layout(constant_id = 0) const bool PERSPECTIVE = true;

layout(set = 0, binding = 0, std140) uniform Frame {
    vec4 rows_hi[3];         // world → homogeneous pixel (x, y, w) for a position relative to the eye, each entry the sum of two
    vec4 rows_lo[3];         //   floats; .w is the row's value at the eye
    vec4 eye_hi;             // the eye, likewise
    vec4 eye_lo;
    vec4 ray_hi[3];          // world vectors: κ of the plane n·x = h at pixel (x, y) is
    vec4 ray_lo[3];          //   n·(ray[0] x + ray[1] y + ray[2]) / h in perspective, and
    vec4 forward_hi;         //   (n·(ray[0] x + ray[1] y + ray[2]) − key_slope h) / n·forward otherwise,
    vec4 forward_lo;         //   where forward is the unit viewing direction
    vec4 flat_rows[2];       // world vector → pixel (x, y) at distance 1, whatever its extent along the viewing direction
    vec2 viewport;           // px
    float jacobian;          // |det| of the rows, or of parallel rays' x and y: scales √|V|
    float near;
    float key_slope;         // orthographic: −dκ/dz
    float key_far;           // κ of the far plane
    float key_gain;          // scales κ before it is summed, so that half floats hold it
    float cutoff;            // F, σ
    float epsilon;           // ε in radii
    float visibility_lowpass; // px²
    float attribute_lowpass;  // px²; see attribute_variance in splat.glsl
    float ambient;
    vec4 background;         // linear, α
    vec4 albedo;             // .rgb; .a is the headlight's factor
    float specular;
    float shininess;
    float kernel_a;          // of a Confetti kernel
    float kernel_n;
    vec4 to_light[4];
    vec4 radiance[4];
    vec2 origin;             // of the picture in what is drawn to, px
    float scale;             // of a scene that is placed (lib/placed.glsl): a unit of its own in the world's, and
    float world_near;        //   near and key_slope as the world has them
    float world_key_slope;
    vec4 turn[3];            // columns: directions of its own axes in the world's
} frame;
