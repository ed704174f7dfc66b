// Push constants of passes that read the hierarchy of boxes.

#ifndef LIB_HIERARCHY
#define LIB_HIERARCHY

// Start of each level of the box hierarchy: level 0 has the boxes of splats, a node of level 3 is a block of 512.
layout(push_constant) uniform Hierarchy {
    uint starts[10];
    uint attribute_rows; // per splat
    // The root of the dispatch: a group of siblings. If SLICED there are several dispatches, each of which resumes the state of the
    // previous one; slices count from 0.
    uint level;
    uint group;
    uint slice;
    uint slices;
    uint most_steps; // of a walk
    uint frame_number;
    uint fronts; // 1: only splats that face the eye, before pass sides; 2: in the tiles that pass hidden has marked
    uvec2 first_tile; // column and row of the dispatch's first tile
} hierarchy;

#endif
