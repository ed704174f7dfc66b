// Order: sorts the surfels of a chunk along a Morton curve through the scene's bounds, by DIGIT_BITS bits of the code at a time, the lowest
// first. The entries are divided into runs, one per invocation. A run counts its digits; the prefix sums over digits and runs (TOTALS, SCAN) are
// the positions to which a run moves its entries (SCATTER). The sort is stable and has no atomics: every frame has the same order, whatever
// the number of runs. CPU devices have few and long ones, GPUs many.
#version 450
#pragma variant TOTALS
#pragma variant SCAN
#pragma variant SCATTER
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/surfels.glsl"
#define ORDER_ACCESS
#include "lib/order.glsl"

layout(local_size_x = 64) in;

// A step of the sort. The buffer has two arrays of indices, two of codes, with `capacity` entries each, then a counter per digit and run, and
// the sum of each digit's counters.
layout(push_constant) uniform OrderStep {
    vec4 curve;    // least corner of the scene's bounds; cells of the curve per unit of length
    uint count;    // surfels
    uint capacity;
    uint runs;
    uint digit;    // 0 is the lowest
} pass;

const uint DIGIT_BITS = 8, DIGITS = 1 << DIGIT_BITS, LAST_DIGIT = 3;

uint counter(uint digit, uint run) {
    return 4 * pass.capacity + digit * pass.runs + run;
}

// Start of the indices that a step reads, or writes; the codes follow two arrays later. The last step writes to the first array.
uint source() {
    return (pass.digit & 1u) != 0 ? pass.capacity : 0;
}

uint destination() {
    return pass.capacity - source();
}

// Bits of a number of 10 bits, two apart.
uint spread(uint v) {
    v = (v | v << 16) & 0x030000ffu;
    v = (v | v << 8) & 0x0300f00fu;
    v = (v | v << 4) & 0x030c30c3u;
    return (v | v << 2) & 0x09249249u;
}

// Morton code of a position; of any cell, if it is not finite.
uint code_of(vec3 position) {
    uvec3 cell = uvec3(clamp((position - pass.curve.xyz) * pass.curve.w, 0.0, 1023.0)) & 1023u;
    return spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2;
}

// Code of an entry. The first count computes and stores it.
uint code_of_entry(uint i) {
    uint at = source() + 2 * pass.capacity + i;
#ifndef SCATTER
    if (pass.digit == 0) {
        uint code = code_of(position_of(i));
        order[at] = code;
        return code;
    }
#endif
    return order[at];
}

uint digit_of(uint code) {
    return code >> DIGIT_BITS * pass.digit & DIGITS - 1;
}

#if defined(TOTALS) || defined(SCAN)

// Invocations whose values are added up first.
const uint GROUP = 8, GROUPS = gl_WorkGroupSize.x / GROUP;

shared uint sums[gl_WorkGroupSize.x];
shared uint group_sums[GROUPS];

// Sum of the values of the workgroup's invocations; of those before this one, in `before`.
uint workgroup_sum(uint value, out uint before) {
    uint lane = gl_LocalInvocationIndex, group = lane / GROUP, of_group = 0, sum = 0;
    barrier();
    sums[lane] = value;
    barrier();
    before = 0;
    for (uint k = 0; k < GROUP; k++) {
        uint other = sums[GROUP * group + k];
        of_group += other;
        before += k < lane % GROUP ? other : 0;
    }
    if (lane % GROUP == 0) group_sums[group] = of_group;
    barrier();
    for (uint k = 0; k < GROUPS; k++) {
        sum += group_sums[k];
        before += k < group ? group_sums[k] : 0;
    }
    return sum;
}

// A workgroup per digit. TOTALS adds up the digit's counters; then SCAN replaces them by the sums of those before them.
void main() {
    uint digit = gl_WorkGroupID.x, lane = gl_LocalInvocationIndex, totals = counter(DIGITS, 0);
    uint length = (pass.runs + gl_WorkGroupSize.x - 1) / gl_WorkGroupSize.x;
    uint first = min(lane * length, pass.runs), end = min(first + length, pass.runs);
    uint sum = 0, before;
    for (uint run = first; run < end; run++) sum += order[counter(digit, run)];
    uint total = workgroup_sum(sum, before);
#ifdef TOTALS
    if (lane == 0) order[totals + digit] = total;
#else
    uint of_lower = 0, unused;
    for (uint lower = lane; lower < digit; lower += gl_WorkGroupSize.x) of_lower += order[totals + lower];
    before += workgroup_sum(of_lower, unused);
    for (uint run = first; run < end; run++) {
        uint at = counter(digit, run), count = order[at];
        order[at] = before;
        before += count;
    }
#endif
}

#else

void main() {
    uint run = gl_GlobalInvocationID.x;
    if (run >= pass.runs) return;
    uint length = (pass.count + pass.runs - 1) / pass.runs;
    uint first = run * length, end = min(first + length, pass.count);
#ifndef SCATTER
    for (uint digit = 0; digit < DIGITS; digit++) order[counter(digit, run)] = 0;
#endif
    for (uint i = first; i < end; i++) {
        uint code = code_of_entry(i), at = counter(digit_of(code), run), position = order[at];
        order[at] = position + 1;
#ifdef SCATTER
        order[destination() + position] = pass.digit == 0 ? i : order[source() + i];
        if (pass.digit < LAST_DIGIT) order[destination() + 2 * pass.capacity + position] = code;
#endif
    }
}

#endif
#endif
