// Sums of pixels in the buffers of the compute path: see lib/sums.glsl.

void load_sums(uint index, out vec4 s0, out vec4 s1) {
    s0 = s1 = vec4(0.0);
    if (WIDE_SUMS0) for (uint k = 0; k < 4; k++) s0[k] = sums0[4 * index + k];
    else s0.x = sums0[index];
    if (WIDE_SUMS1) for (uint k = 0; k < 4; k++) s1[k] = sums1[4 * index + k];
    else if (SUM_DEPTH) s1.x = sums1[index];
}

#ifdef STORES_SUMS
void store_sums(uint index, vec4 s0, vec4 s1) {
    if (WIDE_SUMS0) for (uint k = 0; k < 4; k++) sums0[4 * index + k] = s0[k];
    else sums0[index] = s0.x;
    if (WIDE_SUMS1) for (uint k = 0; k < 4; k++) sums1[4 * index + k] = s1[k];
    else if (SUM_DEPTH) sums1[index] = s1.x;
}
#endif
