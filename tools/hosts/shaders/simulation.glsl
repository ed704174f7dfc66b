// Points of a tube that moves (host/simulation.rs).
#version 450

#ifdef COMPUTE
layout(local_size_x = 64) in;
struct Vertex { vec3 position; float radius; vec3 normal; uint colour; };
layout(set = 0, binding = 0, std430) writeonly buffer Vertices { Vertex vertices[]; };
layout(push_constant) uniform Push { float time; uint side; } push;

const float TAU = 6.2831853;

// Every other bit of a number: along a curve through the grid, so that neighbours on the surface are neighbours in memory.
uint every_other(uint x) {
    x &= 0x55555555u;
    x = (x | x >> 1) & 0x33333333u;
    x = (x | x >> 2) & 0x0f0f0f0fu;
    x = (x | x >> 4) & 0x00ff00ffu;
    return (x | x >> 8) & 0x0000ffffu;
}

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.side * push.side) return;
    vec2 place = (vec2(every_other(i), every_other(i >> 1)) + 0.5) / float(push.side);
    float u = TAU * place.x, v = TAU * place.y;
    float wave = 7.0 * u + 2.0 * v - push.time;
    float tube = 0.36 * (1.0 + 0.22 * sin(wave)), bend = 0.36 * 0.22 * cos(wave);
    float reach = 1.0 + tube * cos(v);
    vec3 outward = vec3(cos(u), 0.0, sin(u)), along = vec3(-sin(u), 0.0, cos(u)), up = vec3(0.0, 1.0, 0.0);
    // Derivatives by u and by v.
    vec3 swell = cos(v) * outward + sin(v) * up;
    vec3 du = reach * along + 7.0 * bend * swell;
    vec3 dv = tube * (cos(v) * up - sin(v) * outward) + 2.0 * bend * swell;
    vec3 light = mix(vec3(0.9, 0.45, 0.1), vec3(0.95, 0.9, 0.8), step(0.0, sin(12.0 * u) * sin(6.0 * v)));
    Vertex vertex;
    vertex.position = reach * outward + tube * sin(v) * up;
    vertex.radius = 0.75 * TAU / float(push.side) * length(vec2(length(du), length(dv)));
    vertex.normal = normalize(cross(dv, du));
    vertex.colour = packUnorm4x8(vec4(light, 1.0));
    vertices[i] = vertex;
}
#endif
