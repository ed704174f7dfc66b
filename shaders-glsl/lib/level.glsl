// The level that a step of pull or push computes. The levels of a pyramid lie side by side in its images (src/frame/pyramids.rs).

layout(push_constant) uniform Step {
    ivec2 size;            // width and height, pixels of the level
    ivec2 to_origin;       // its first texel in the pyramid that is written
    ivec2 from_origin;     // and in the one that a push reads
    ivec2 adjacent_size;   // of the other level that is read: the finer one in a pull, the coarser one in a push, 0 at the top
    ivec2 adjacent_origin; // its first texel
    uint level;            // 0 is the finest
} pass;
