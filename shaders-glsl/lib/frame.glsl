// What every pass knows of the settings, the picture and the camera; src/frame/uniforms.rs fills it, once a frame.
// World space here is relative to the scene's origin; for passes over an instance it is the scene's own space, with its own unit. κ, the
// depth key, is near / z in perspective and linear in z otherwise: 1 at the near plane, falling with distance, and affine on the screen for
// every plane.

layout(constant_id = 0) const bool PERSPECTIVE = true;

// What all instances have alike.
layout(set = 0, binding = 0, std140) uniform Frame {
    vec2 viewport;           // px
    float near;
    float key_slope;         // orthographic: −dκ/dz
    float key_far;           // κ of the far plane
    float key_gain;          // scales κ before it is summed, so that half floats hold it
    float cutoff;            // F, σ
    float epsilon;           // ε in radii
    float visibility_lowpass; // px²
    float attribute_lowpass;  // px²; see attribute_variance in splat.glsl
    float kernel_a;          // of a Confetti kernel
    float kernel_n;
    vec4 background;         // linear, α
    vec4 albedo;             // .rgb; .a is the headlight's factor
    vec4 radiance[4];
    float ambient;
    float specular;
    float shininess;
    vec2 origin;             // of the picture in what is drawn to, px
} frame;

#ifdef TILE_PASS
// The same in registers: within loops lavapipe loads uniforms lane by lane.
struct FrameValues {
    vec2 viewport;
    float near, key_far, key_gain, cutoff, visibility_lowpass, attribute_lowpass, kernel_a, kernel_n;
    vec4 background, albedo, radiance[4];
    float ambient, specular, shininess;
} frame_values;

void load_frame() {
    frame_values = FrameValues(frame.viewport, frame.near, frame.key_far, frame.key_gain, frame.cutoff, frame.visibility_lowpass,
                               frame.attribute_lowpass, frame.kernel_a, frame.kernel_n, frame.background, frame.albedo,
                               frame.radiance, frame.ambient, frame.specular, frame.shininess);
}
#define frame frame_values
#endif


// The camera as a scene has it in its own axes and unit.
struct View {
    vec4 rows_hi[3];         // world → homogeneous pixel (x, y, w) for a position relative to the eye, each entry the sum of two
    vec4 rows_lo[3];         //   floats; .w is the row's value at the eye
    vec4 eye_hi;             // the eye, likewise
    vec4 eye_lo;
    vec4 ray_hi[3];          // world vectors: κ of the plane n·x = h at pixel (x, y) is
    vec4 ray_lo[3];          //   n·(ray[0] x + ray[1] y + ray[2]) / h in perspective, and
    vec4 forward_hi;         //   (n·(ray[0] x + ray[1] y + ray[2]) − key_slope h) / n·forward otherwise,
    vec4 forward_lo;         //   where forward is the unit viewing direction
    vec4 flat_rows[2];       // world vector → pixel (x, y) at distance 1, whatever its extent along the viewing direction
    vec4 to_light[4];
    vec4 turn[3];            // columns: directions of its axes in the world's
    float scale;             // its unit in the world's
    float near;
    float key_slope;
    float jacobian;          // |det| of the rows, or of parallel rays' x and y: scales √|V|
    uint first;              // number of the first point of the instance in the frame
};

// As many as a uniform buffer of 16 KiB has, which every device binds.
const uint MOST_INSTANCES = 37;

layout(set = 0, binding = 6, std140) uniform Views { View views[MOST_INSTANCES]; };

// Fragments of several instances are drawn together, and do not know of which one they are.
#ifdef OF_SCENE
#ifndef FRAGMENT
uint instance_number();
#define view views[instance_number()]
#endif
#else
#define view views[0]
#endif
