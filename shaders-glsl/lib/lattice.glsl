// Samples of a pixel.

#ifndef LIB_LATTICE
#define LIB_LATTICE

const uint SAMPLES = 16;

// Sample k relative to the pixel's centre, px: a lattice with one sample in each of 16 rows and of 16 columns, no two nearer than 0.19 px.
vec2 sample_at(uint k) {
    return (vec2(k, 13 * k % SAMPLES) + 0.5) / SAMPLES - 0.5;
}

#endif
