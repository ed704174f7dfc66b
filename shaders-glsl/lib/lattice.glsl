// Sample positions of a pixel.

#ifndef LIB_LATTICE
#define LIB_LATTICE

const uint SAMPLES = 16;
const uint ALL_SAMPLES = (1u << SAMPLES) - 1;

// Sample k relative to the pixel's centre, px: a rank-1 lattice with one sample in each of 16 rows and columns, at least 0.19 px apart.
vec2 sample_position(uint k) {
    return (vec2(k, 13 * k % SAMPLES) + 0.5) / SAMPLES - 0.5;
}

#endif
