// A scene that is placed is seen in its own axes and its own unit, in which all is as in the world, κ and pixels too; directions and distances
// that leave it, for what scenes share, are turned and scaled.

layout(constant_id = 37) const bool PLACED = false;

// A direction of the scene's in the world.
vec3 in_world(vec3 direction) {
    if (!PLACED) return direction;
    return frame.turn[0].xyz * direction.x + frame.turn[1].xyz * direction.y + frame.turn[2].xyz * direction.z;
}

// A distance from the eye, in front of the near plane, in the world's unit: no nearer than the near plane by rounding.
float world_distance(float distance) {
    return PLACED ? max(frame.scale * distance, frame.world_near) : distance;
}
