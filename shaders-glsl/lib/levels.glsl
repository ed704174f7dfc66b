// Levels of detail: of a point and the aggregated surfels that stand for it, one per level, exactly one is drawn. A level suffices in a cell
// whose side is at most τ px at the point of the cell that is nearest to the eye. A cell lies within that of the next level, at half its side,
// so that a level suffices wherever a coarser one does; rounding keeps that order. The cells of a surfel follow from its position: sides are
// powers of two (src/geometry/levels).

#ifndef LIB_LEVELS
#define LIB_LEVELS

layout(constant_id = 73) const bool HAS_LEVELS = false; // the scene has levels of detail

const uint MOST_LEVELS = 12; // as in src/geometry/levels/mod.rs

// Level of a surfel of the scene: 0 for points, then from the finest to the coarsest.
uint level_of(uint id) {
    uint level = 0;
    for (uint k = 0; k < MOST_LEVELS / 4; k++) {
        uvec4 reached = uvec4(greaterThanEqual(uvec4(id), view.level_starts[k]));
        level += reached.x + reached.y + reached.z + reached.w;
    }
    return level;
}

// Side of the cells of a level from 1 on.
float cell_side(uint level) {
    return view.level_spacing * float(1u << (level - 1u));
}

bool is_coarsest(uint level) {
    return level == MOST_LEVELS || view.level_starts[level / 4][level % 4] == ~0u;
}

// Inverse of a power of two. A division may round.
float inverse_of(float power) {
    return uintBitsToFloat((254u << 23) - floatBitsToUint(power));
}

// Squared distance of the eye from a box, given relative to the eye.
float squared_distance_to(vec3 low, vec3 high) {
    precise vec3 away = max(max(low, -high), vec3(0.0));
    precise float squared = away.x * away.x + away.y * away.y + away.z * away.z;
    return squared;
}

// Whether cells of this side suffice at this squared distance.
bool suffices_at(float side, float squared_distance) {
    precise float reach = side * view.level_reach;
    precise float squared_reach = reach * reach;
    return squared_reach <= (PERSPECTIVE ? squared_distance : 1.0);
}

// Whether the cell with this position, of cells of this side, suffices.
bool suffices(vec3 position, float side) {
    precise vec3 low = floor(position * inverse_of(side)) * side;
    precise vec3 high = low + side;
    precise vec3 low_from_eye = (low - view.eye_hi.xyz) - view.eye_lo.xyz;
    precise vec3 high_from_eye = (high - view.eye_hi.xyz) - view.eye_lo.xyz;
    return suffices_at(side, squared_distance_to(low_from_eye, high_from_eye));
}

// Whether surfel `id` of the scene is of the level that is drawn at its position.
bool is_of_drawn_level(uint id, vec3 position) {
    uint level = level_of(id);
    if (level > 0 && !suffices(position, cell_side(level))) return false;
    return is_coarsest(level) || !suffices(position, cell_side(level + 1));
}

#endif
