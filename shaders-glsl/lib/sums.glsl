// Which weighted sums a frame keeps. Target 0 is (Σw, Σw a), target 1 is (Σw κ, Σw rgb); each ends after its first channel where
// the frame wants no more, and target 1 is absent where it would be empty. a is the normal where normals are wanted, else the colour.

#ifndef LIB_SUMS
#define LIB_SUMS

layout(constant_id = 3) const bool SUM_NORMALS = true;
layout(constant_id = 4) const bool SUM_DEPTH = false;
layout(constant_id = 5) const uint COLOURS = 0;            // how the scene holds the colours that the frame wants
layout(constant_id = 17) const bool SUM_COLOURS = false;   // colours are summed, the scene's or light
layout(constant_id = 18) const uint NORMALIZATION = 0;     // as in src/settings/splatting.rs
layout(constant_id = 19) const bool OVERLAP = false;       // every splat weighs 1: Σw is their number

const uint PER_PIXEL = 0, PER_SURFEL = 1, NONE = 2;

// Whether Σw is wanted: something is divided by it, or held against it.
const bool SUM_WEIGHTS = NORMALIZATION == PER_PIXEL || SUM_DEPTH || SUM_NORMALS;
// Whether target 0 holds a vector beside Σw.
const bool WIDE_SUMS0 = SUM_NORMALS || SUM_COLOURS;
// Whether target 1 holds colours beside the depth sum.
const bool WIDE_SUMS1 = SUM_NORMALS && SUM_COLOURS;

#endif
