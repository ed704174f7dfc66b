// A lit mesh (host/mesh.rs).
#version 450

layout(push_constant) uniform Push { mat4 world_to_clip; vec4 to_light; } push;

#ifdef VERTEX
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 0) out vec3 out_normal;

void main() {
    gl_Position = push.world_to_clip * vec4(position, 1.0);
    out_normal = normal;
}
#endif

#ifdef FRAGMENT
layout(location = 0) in vec3 normal;
layout(location = 0) out vec4 colour;

void main() {
    float light = 0.15 + 0.85 * max(dot(normalize(normal), push.to_light.xyz), 0.0);
    colour = vec4(light * vec3(0.15, 0.35, 0.8), 1.0);
}
#endif
