// Cull reasons: why a surfel is not drawn, counted in this order; DRAWN is none.

const uint BEHIND = 0;    // the centre is not in front of the eye; a point's not between near and far plane
const uint EYE_PLANE = 1; // the disc reaches the eye plane, or all but does
const uint BACK = 2;      // the normal faces away, such are culled, and the surfel is not two-sided
const uint OUTSIDE = 3;   // off the picture, or without an area on it
const uint INVALID = 4;   // marked by a radius of 0, or with an image too large for floats
const uint DRAWN = 5;

#ifdef COMPUTE

layout(constant_id = 2) const bool COUNT = false;

layout(set = 2, binding = 5, std430) buffer Counts { uint culled[5]; };

void count(uint reason) {
    if (COUNT && reason != DRAWN) atomicAdd(culled[reason], 1);
}

#endif
