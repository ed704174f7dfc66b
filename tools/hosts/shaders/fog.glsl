// Fog over what is drawn, by its depth (host/fog.rs).
#version 450
#pragma variant MULTISAMPLED FRAGMENT

#ifdef VERTEX
void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 3.0 : -1.0, gl_VertexIndex == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
#endif

#ifdef FRAGMENT
layout(location = 0) out vec4 colour;
layout(push_constant) uniform Push { vec4 fog; float density; } push;

// Depth falls with distance, from 1: as much fog as there is way behind it.
float fog(float depth) {
    return exp(-push.density * depth);
}

#ifdef MULTISAMPLED
layout(constant_id = 0) const int SAMPLES = 4;
layout(set = 0, binding = 0, input_attachment_index = 0) uniform subpassInputMS depths;

float mean_fog() {
    float sum = 0.0;
    for (int k = 0; k < SAMPLES; k++) sum += fog(subpassLoad(depths, k).r);
    return sum / float(SAMPLES);
}
#else
layout(set = 0, binding = 0, input_attachment_index = 0) uniform subpassInput depths;

float mean_fog() {
    return fog(subpassLoad(depths).r);
}
#endif

void main() {
    float f = mean_fog();
    colour = vec4(f * push.fog.rgb, f);
}
#endif
