// Which weighted sums a frame keeps. Target 0 is (Σw, Σw a), target 1 is (Σw κ, Σw rgb); each ends after its first channel where
// the frame wants no more, and target 1 is absent where it would be empty. a is the normal where normals are wanted, else the colour.

layout(constant_id = 3) const bool SUM_NORMALS = true;
layout(constant_id = 4) const bool SUM_DEPTH = false;
layout(constant_id = 5) const uint COLOURS = 0; // how the scene holds the colours that the frame wants

const uint COLOURS_NONE = 0, COLOURS_SRGB8 = 1, COLOURS_LINEAR = 2;
