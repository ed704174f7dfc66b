// Bounds of clusters of surfels, which the scene has or lacks.

// Bounds of the surfels of a cluster, without invalid ones.
struct Cluster {
    vec4 low;  // least corner of the centres; .w is the largest radius, below 0 if there is no surfel
    vec4 high; // greatest corner; .w is the sine of the angle from the cone's axis within which all normals are, 2 if there is no such cone
    vec4 axis; // of the normal cone
};

// Consecutive clusters of an instance.
struct Group {
    uint first;    // first cluster, in the chunk
    uint count;    // clusters
    uint slot;     // of the first cluster in the chunk's range of the frame's splat list
    uint instance; // in the descriptor set, or NO_INSTANCE
};

// Instance of a group without clusters, whose slots are empty.
const uint NO_INSTANCE = ~0u;

layout(set = 0, binding = 23, std430) readonly buffer Groups { Group groups[]; };
layout(set = 0, binding = 22, std430) readonly buffer Clusters { Cluster clusters[]; };

// Bound of the relative rounding errors of a sum of three products.
const float ROUNDING = 1e-6;

// Bounds of the values of gradient·p + constant for points p in a box.
vec2 bounds_on(vec3 gradient, float constant, vec3 low, vec3 high) {
    vec3 a = gradient * low, b = gradient * high;
    vec3 least = min(a, b), most = max(a, b);
    vec3 size = max(abs(least), abs(most));
    float margin = ROUNDING * (size.x + size.y + size.z + abs(constant));
    return vec2(least.x + least.y + least.z + constant - margin, most.x + most.y + most.z + constant + margin);
}

// Box of a cluster's centres, relative to the eye.
struct CentreBox {
    vec3 low;
    vec3 high;
};

CentreBox centres_of(Cluster cluster) {
    return CentreBox((cluster.low.xyz - view.eye_hi.xyz) - view.eye_lo.xyz, (cluster.high.xyz - view.eye_hi.xyz) - view.eye_lo.xyz);
}

// How far the low-pass filter, the rounding of whole sprites, and rounding errors extend splats, px.
float splat_margin() {
    return largest_stretch() * frame.cutoff * sqrt(frame.attribute_lowpass + frame.visibility_lowpass) + 2.0;
}
