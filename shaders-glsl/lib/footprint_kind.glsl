// Kinds of footprints, and their extent relative to F σ of the projected ellipse.

layout(constant_id = 15) const uint FOOTPRINT = 0;        // as in src/settings/splatting.rs

const uint CONIC = 0, AFFINE = 1, PARALLELOGRAM = 2, DISC = 3, SPRITE = 4, WHOLE_SPRITE = 5, SQUARE = 6, FLAT_SPRITE = 7,
           POINT = 8;

// Whether the kernel lies in the tangent plane.
bool on_plane() {
    return PERSPECTIVE && (FOOTPRINT == PARALLELOGRAM || FOOTPRINT == DISC);
}

bool is_sprite() {
    return FOOTPRINT == SPRITE || FOOTPRINT == WHOLE_SPRITE || FOOTPRINT == FLAT_SPRITE;
}

// Whether distance, not inverse distance, is affine on the screen.
bool has_linear_depth() {
    return PERSPECTIVE && is_sprite();
}

// Half the diagonal of a footprint with semi-axes 1: it is bounded by a square around them, or by an ellipse.
float rim() {
    return FOOTPRINT == PARALLELOGRAM || FOOTPRINT == SQUARE ? 1.4142137 : 1.0;
}

// Largest factor by which perspective scales a kernel in the tangent plane, relative to its centre: beyond it the plane nears its horizon,
// and a parallelogram would reach behind the eye.
const float MOST_STRETCH = 2.0;

// Upper bound of stretch_of.
float largest_stretch() {
    return on_plane() ? MOST_STRETCH * rim() : rim();
}
