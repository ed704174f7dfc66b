// Materials of points: a table, and by the number of each surfel, segment and triangle which of it it has.

// Number of materials; of each the specular factor and the exponent; then the numbers, two to a word, the first in its lower half.
layout(set = 0, binding = 18, std430) readonly buffer Materials { uint count; uint words[]; } materials;

Shine shine_of(uint point) {
    uint number = materials.words[4 * materials.count + point / 2] >> 16 * (point % 2) & 0xffffu;
    // What has none is beyond the table.
    if (number >= materials.count) return FRAME_SHINE;
    uint k = 4 * number;
    uvec4 bits = uvec4(materials.words[k], materials.words[k + 1], materials.words[k + 2], materials.words[k + 3]);
    return Shine(uintBitsToFloat(bits.rgb), uintBitsToFloat(bits.a));
}
