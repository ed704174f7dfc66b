// Frame uniforms: settings, viewport and camera; src/frame/uniforms.rs writes them once per frame. World space is relative to the scene's
// origin here; in passes over an instance it is the scene's own space and unit. κ, the depth key, is near / z in perspective and linear in
// z otherwise: 1 at the near plane, decreasing with distance, affine on the screen for every plane. Parallel rays: distances are counted from
// a plane near the scene, and κ is 1 and ½ at planes near it, so that float32 resolves depths relative to the scene.

layout(constant_id = 0) const bool PERSPECTIVE = true;

// Uniforms shared by all instances.
layout(set = 0, binding = 0, std140) uniform Frame {
    vec2 viewport;            // px
    float near;
    float key_slope;          // orthographic: −dκ/dz
    float key_far;            // κ of the camera's far plane
    float key_near;           // κ of the camera's near plane: 1 in perspective
    float key_gain;           // scales κ before summation, so that half floats hold it
    float key_reach;          // how much nearer than its disc a fragment's depth may be: a factor of κ in perspective, else added to it
    float cutoff;             // F, σ
    float epsilon;            // ε in radii
    float visibility_lowpass; // px²
    float attribute_lowpass;  // px²; see attribute_variance in splat.glsl
    float kernel_a;           // of a Confetti kernel
    float kernel_n;
    vec4 background;          // linear, α
    vec4 albedo;              // .rgb; .a is the headlight's factor
    vec4 radiance[4];
    float ambient;
    float specular;
    float shininess;
    float pixel_filter;       // variance of the filter after shading, px²
    float edl;                // strength of eye-dome lighting
    float ao;                 // strength of ambient occlusion
    float pixel_width;        // at distance 1 in perspective, at every distance otherwise
    vec2 origin;              // of the viewport in the target, px
} frame;

#ifdef TILE_PASS
// A copy in registers: lavapipe loads uniforms lane by lane inside loops.
struct FrameValues {
    vec2 viewport;
    float near, key_far, key_near, key_gain, key_reach, cutoff, visibility_lowpass, attribute_lowpass, kernel_a, kernel_n;
    vec4 background, albedo, radiance[4];
    float ambient, specular, shininess;
} frame_values;

void load_frame() {
    frame_values = FrameValues(frame.viewport, frame.near, frame.key_far, frame.key_near, frame.key_gain, frame.key_reach, frame.cutoff,
                               frame.visibility_lowpass, frame.attribute_lowpass, frame.kernel_a, frame.kernel_n,
                               frame.background, frame.albedo, frame.radiance, frame.ambient, frame.specular, frame.shininess);
}
#define frame frame_values
#endif

// κ of the nearest fragments.
float nearest_key() {
    return PERSPECTIVE ? 1.0 : frame.key_near;
}


// Camera in the axes and unit of a scene.
struct View {
    vec4 rows_hi[3];   // world → homogeneous pixel (x, y, w) for a position relative to the eye, each entry the sum of two
    vec4 rows_lo[3];   //   floats; .w is the row's value at the eye
    vec4 eye_hi;       // the eye, likewise
    vec4 eye_lo;
    vec4 ray_hi[3];    // world vectors: κ of the plane n·x = h at pixel (x, y) is
    vec4 ray_lo[3];    //   n·(ray[0] x + ray[1] y + ray[2]) / h in perspective, and
    vec4 forward_hi;   //   (n·(ray[0] x + ray[1] y + ray[2]) − key_slope h) / n·forward otherwise,
    vec4 forward_lo;   //   where forward is the unit viewing direction
    vec4 flat_rows[2]; // world vector → pixel (x, y) at distance 1, whatever its extent along the viewing direction
    vec4 to_light[4];
    vec4 rotation[3];  // columns: axes of the scene in world space
    float scale;       // world units per unit of the scene
    float near;
    float key_slope;
    float jacobian;    // |det| of the rows, or of parallel rays' x and y: scales √|V|
    uint first_id;     // id of the instance's first point
    float level_spacing; // side of the cells of the finest level of detail, in the scene's unit
    float level_reach;   // distance at which a cell of side 1 suffices, in sides; with parallel rays, the side that just suffices is 1 / this
    float distance_offset; // parallel rays: distance of the plane that distances are counted from, world units
    uvec4 level_starts[3]; // first surfel of each level, ~0 beyond the last one
};

// As many as fit 16 KiB, the least maxUniformBufferRange.
const uint MOST_INSTANCES = 34;

layout(set = 0, binding = 6, std140) uniform Views { View views[MOST_INSTANCES]; };

// Fragment shaders do not know their instance: a draw is of several.
#ifdef PER_INSTANCE
#ifndef FRAGMENT
uint instance_index();
#define view views[instance_index()]
#endif
#else
#define view views[0]
#endif
