// Past an outline of its own surface, a disc is at most so far behind that surface as it is seen beside the disc; widths of a pixel, and in
// proportion to the root of the radius, px. A pixel's width w from the outline, a surface with a radius of curvature of R disc radii r is
// √(2 R r w) nearer than at it: at most 8 √(r w) for R = 32, the limit of sides.glsl.
const float BEHIND_BESIDE = 8.0;
