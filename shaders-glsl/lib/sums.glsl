// Weighted sums of a frame. Target 0 is (Σw, Σw a), target 1 is (Σw κ, Σw rgb), where a is the normal if the frame needs normals, else the
// colour. Channels after the first are absent if unused, and so is target 1.

#ifndef LIB_SUMS
#define LIB_SUMS

layout(constant_id = 3) const bool SUM_NORMALS = true;
layout(constant_id = 4) const bool SUM_DEPTH = false;
layout(constant_id = 5) const uint COLOURS = 0;            // colour format of the scene, if the frame reads colours
layout(constant_id = 17) const bool SUM_COLOURS = false;   // colours are summed, of the scene or lit
layout(constant_id = 18) const uint NORMALIZATION = 0;     // as in src/settings/splatting.rs
layout(constant_id = 19) const bool OVERLAP = false;       // all weights are 1: Σw counts splats

const uint PER_PIXEL = 0, PER_SURFEL = 1, NONE = 2;

// Whether Σw is read: as a divisor, or by a test.
const bool SUM_WEIGHTS = NORMALIZATION == PER_PIXEL || SUM_DEPTH || SUM_NORMALS;
// Whether target 0 has a vector after Σw.
const bool WIDE_SUMS0 = SUM_NORMALS || SUM_COLOURS;
// Whether target 1 has colours after the depth sum.
const bool WIDE_SUMS1 = SUM_NORMALS && SUM_COLOURS;

#endif
