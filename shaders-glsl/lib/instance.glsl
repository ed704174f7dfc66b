// An instance of a scene. It is seen in the scene's own axes and unit, in which all is as in the world, κ and pixels too; directions and
// distances that instances share are turned and scaled. A dispatch is of several instances, each a row of workgroups along z, and so is a
// draw, whose vertices are those of one instance after the other: as Vulkan instances of few vertices each they would cost more.

#define OF_SCENE
#include "lib/frame.glsl"

layout(constant_id = 37) const bool INSTANCED = false; // there are instances: each has its own numbers

#ifndef FRAGMENT
// The surfels, lines or triangles of a command, and where those of each instance begin in what frames make of them.
layout(push_constant) uniform Window {
    uint count;    // of surfels, lines or triangles
    uint first;    // number of the first in the scene
    uint capacity; // surfels that the scene has room for in the window
    uint room;     // elements of each instance in a buffer with an element for each of them
    uint clips;    // elements of each instance in the buffer of screen clips
    uint instance; // number of the first instance, of those that the descriptor set names
    uint first_clip; // number in the frame of the first clip on the screen that the descriptor set names
    uint attribute_rows; // of a splat in the frame's list
    uint present;  // instances of the frame, of those that the descriptor set names
} window;

#ifdef VERTEX
// The surfel of a vertex: those of all instances follow each other.
uint surfel_number() {
    uint i = gl_VertexIndex / VERTICES;
    return INSTANCED ? i % window.count : i;
}
#endif

// Number of the instance, of those that the descriptor set names.
uint instance_number() {
#ifdef VERTEX
    return INSTANCED ? window.instance + gl_VertexIndex / VERTICES / window.count : 0;
#else
    return INSTANCED ? window.instance + gl_WorkGroupID.z : 0;
#endif
}

// Words before the lists in a buffer with one for each instance: those hold how long each is.
const uint LIST_HEADER = 64;

// Where the instance's list begins in such a buffer.
uint list_start() {
    return LIST_HEADER + instance_number() * window.room;
}

// Number in the frame of the first point of the window.
uint first_number() {
    return window.first + (INSTANCED ? view.first : 0);
}

// A direction of the scene's in the world.
vec3 in_world(vec3 direction) {
    if (!INSTANCED) return direction;
    return view.turn[0].xyz * direction.x + view.turn[1].xyz * direction.y + view.turn[2].xyz * direction.z;
}

// A distance from the eye, in front of the near plane, in the world's unit: no nearer than the near plane by rounding.
float world_distance(float distance) {
    return INSTANCED ? max(view.scale * distance, frame.near) : distance;
}

#endif
