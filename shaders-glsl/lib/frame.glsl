// Frame uniforms: settings, viewport and camera; src/frame/uniforms.rs writes them once per frame. World space is relative to the scene's
// origin here; in passes over an instance it is the scene's own space and unit. κ, the depth key, is near / z in perspective and linear in
// z otherwise: 1 at the near plane, decreasing with distance, affine on the screen for every plane. Parallel rays: distances are counted from
// a plane near the scene, and κ is 1 and ½ at planes near it, so that float32 resolves depths relative to the scene. So it does in perspective
// if the scene is DISTANT: distances are counted likewise, and κ is near / z less its value at a plane behind the scene.

layout(constant_id = 0) const bool PERSPECTIVE = true;
layout(constant_id = 79) const bool DISTANT = false; // perspective: the scene is far away in a narrow field of view

// Uniforms shared by all instances.
layout(set = 0, binding = 0, std140) uniform Frame {
    vec2 viewport;            // px
    float near;
    float key_slope;          // orthographic: −dκ/dz
    float key_far;            // κ of the camera's far plane
    float key_near;           // κ of the camera's near plane: 1 in perspective, unless DISTANT
    float key_gain;           // scales κ before summation, so that half floats hold it
    float key_reach;          // how much nearer than its disc a fragment's depth may be: a factor of κ in perspective, else added to it; DISTANT:
                              // relative to near / z
    vec2 key_offset;          // DISTANT: near / z − κ, as the sum of two floats
    float key_at_zero;        // DISTANT: κ at distance d is (key_at_zero − key_offset d) / (d + distance_offset)
    float distance_offset;    // as that of a view in world units
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
    float near, key_far, key_near, key_gain, key_reach;
    vec2 key_offset;
    float key_at_zero, distance_offset, cutoff, visibility_lowpass, attribute_lowpass, kernel_a, kernel_n;
    vec4 background, albedo, radiance[4];
    float ambient, specular, shininess;
} frame_values;

void load_frame() {
    frame_values = FrameValues(frame.viewport, frame.near, frame.key_far, frame.key_near, frame.key_gain, frame.key_reach, frame.key_offset,
                               frame.key_at_zero, frame.distance_offset, frame.cutoff, frame.visibility_lowpass, frame.attribute_lowpass,
                               frame.kernel_a, frame.kernel_n,
                               frame.background, frame.albedo, frame.radiance, frame.ambient, frame.specular, frame.shininess);
}
#define frame frame_values
#endif

// κ of the nearest fragments.
float nearest_key() {
    return PERSPECTIVE && !DISTANT ? 1.0 : frame.key_near;
}

// κ, or the least above 0 for the depth tests where it is none: far behind the scene, unless it is that of near / z.
float least_tested(float key) {
    return !PERSPECTIVE ? max(key, 1e-6) : DISTANT ? max(key, 1e-19) : key;
}

// near / z of a fragment with this κ, in perspective.
float inverse_depth(float key) {
    return DISTANT ? key + frame.key_offset.x : key;
}

// κ of a point that is farther from the eye than one with this κ, by `part` of the latter's distance, in perspective.
float farther_key(float key, float part) {
    return DISTANT ? key - (key + frame.key_offset.x) * (part / (1.0 + part)) : key / (1.0 + part);
}

// κ at a distance in world units, in perspective; beyond all where it is behind the eye.
float world_key(float distance) {
    if (DISTANT) {
        float z = distance + frame.distance_offset;
        return z > 0.0 ? (frame.key_at_zero - frame.key_offset.x * distance) / z : 2.0;
    }
    return distance > 0.0 ? frame.near / distance : 2.0;
}

// Camera in the axes and unit of a scene.
struct View {
    vec4 rows_hi[3];   // world → homogeneous pixel (x, y, w) for a position relative to the eye, each entry the sum of two
    vec4 rows_lo[3];   //   floats; .w is the row's value at the eye
    vec4 eye_hi;       // the eye, likewise; .w is that of a frame's key_at_zero in the scene's unit
    vec4 eye_lo;
    vec4 ray_hi[3];    // world vectors: κ of the plane n·x = h at pixel (x, y) is
    vec4 ray_lo[3];    //   n·(ray[0] x + ray[1] y + ray[2]) / h in perspective, and
    vec4 forward_hi;   //   (n·(ray[0] x + ray[1] y + ray[2]) − key_slope h) / n·forward otherwise,
    vec4 forward_lo;   //   where forward is the unit viewing direction; .w, if DISTANT: distance_offset, negated, as the sum of two floats
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
    float distance_offset; // parallel rays, and DISTANT: distance of the plane that distances are counted from
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

#if !defined(FRAGMENT) || !defined(PER_INSTANCE)

// Distance from the eye: what perspective divides by.
float from_eye(float distance) {
    return DISTANT ? distance + view.distance_offset : distance;
}

// κ at a distance in the scene's unit.
float key_at_distance(float distance) {
    if (DISTANT) return (view.eye_hi.w - frame.key_offset.x * distance) / from_eye(distance);
    return PERSPECTIVE ? view.near / distance : 1.0 - (distance - view.near) * view.key_slope;
}

#endif
