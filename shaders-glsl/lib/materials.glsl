// Materials of points: a table, and an index into it per surfel, segment and triangle.

// Number of materials; specular factor and exponent of each; then the indices, two per word, the first in the lower half.
layout(set = 0, binding = 18, std430) readonly buffer Materials { uint count; uint words[]; } materials;

Shine shine_of(uint point) {
    uint index = materials.words[4 * materials.count + point / 2] >> 16 * (point % 2) & 0xffffu;
    // Points without a material have indices beyond the table.
    if (index >= materials.count) return FRAME_SHINE;
    uint k = 4 * index;
    uvec4 bits = uvec4(materials.words[k], materials.words[k + 1], materials.words[k + 2], materials.words[k + 3]);
    return Shine(uintBitsToFloat(bits.rgb), uintBitsToFloat(bits.a));
}
