// Filter: convolves the lit picture with a Gaussian, and blends it with the background. It does after light what the low-pass filter of
// splats does before it (zwicker2004 equation 3), so that edges of surfaces are filtered, too.
#version 450
#pragma variant COVERED COMPUTE
#extension GL_GOOGLE_include_directive : require

#ifdef COMPUTE

#include "lib/frame.glsl"
#include "lib/background.glsl"
#ifdef COVERED
#include "lib/covered_tiles.glsl"
#else
#include "lib/tile_size.glsl"
#endif

// An invocation filters a block of pixels row by row, from the sums of the last rows; BLOCK_GROUP in src/frame/recording.rs is the size of a
// workgroup's blocks. Neighbouring columns share what they load.
layout(local_size_x = 16, local_size_y = 4) in;
const int COLUMNS = 4, BLOCK_ROWS = 16;

layout(constant_id = 31) const bool COVERAGE = false; // α is filtered; otherwise it stays, and only pixels with a surface have a colour

layout(set = 1, binding = 3, rgba32f) readonly uniform image2D image_output;
layout(set = 1, binding = 23, rgba32f) writeonly uniform image2D filtered;

const int RADIUS = int(FILTER_RADIUS), TAPS = 2 * RADIUS + 1;

float weights[RADIUS + 1];

// Sum of the weights of the pixels around one along a side of the picture.
float total(int centre, int size) {
    float sum = 0.0;
    for (int k = -RADIUS; k <= RADIUS; k++) sum += centre + k >= 0 && centre + k < size ? weights[abs(k)] : 0.0;
    return sum;
}

// Tiles that pixels of a block depend on, at most.
const int TILE_COLUMNS = (COLUMNS + 2 * RADIUS - 2) / int(TILE) + 2, TILE_ROWS = (BLOCK_ROWS + 2 * RADIUS - 2) / int(TILE) + 2;
// A bit for each of them, row by row from `first_tile` on: those that splats may cover. The others are empty, whatever the image has there.
uint covered_bits = ~0u;
ivec2 first_tile;

void find_covered_tiles(ivec2 first) {
    first_tile = first - RADIUS >> int(TILE_BITS);
#ifdef COVERED
    covered_bits = 0;
    for (int k = 0; k < TILE_COLUMNS * TILE_ROWS; k++) {
        ivec2 tile = first_tile + ivec2(k % TILE_COLUMNS, k / TILE_COLUMNS), inside = clamp(tile, ivec2(0), ivec2(tile_counts()) - 1);
        covered_bits |= uint(inside == tile && covered.tiles[tile_index(uvec2(inside))].key == MARKED) << k;
    }
#endif
}

// The bits of the row of tiles with a row of pixels.
uint covered_bits_of(int y) {
    return covered_bits >> TILE_COLUMNS * ((y >> int(TILE_BITS)) - first_tile.y);
}

// Premultiplied by α; 0 outside the picture, and in tiles that are not covered.
vec4 load(ivec2 pixel, ivec2 size, uint row_bits) {
    ivec2 inside = clamp(pixel, ivec2(0), size - 1);
    vec4 value = imageLoad(image_output, inside);
#ifdef COVERED
    bool is_there = inside == pixel && (row_bits >> (pixel.x >> int(TILE_BITS)) - first_tile.x & 1u) != 0;
#else
    bool is_there = inside == pixel;
#endif
    return is_there ? vec4(value.a * value.rgb, value.a) : vec4(0.0);
}

// Weighted sums along a row, of the pixels from `first` on.
void sum_row(ivec2 first, ivec2 size, out vec4 sums[COLUMNS]) {
    uint row_bits = covered_bits_of(first.y);
    vec4 values[COLUMNS + 2 * RADIUS];
    for (int k = 0; k < COLUMNS + 2 * RADIUS; k++) values[k] = load(first + ivec2(k - RADIUS, 0), size, row_bits);
    for (int c = 0; c < COLUMNS; c++) {
        sums[c] = vec4(0.0);
        for (int k = 0; k < TAPS; k++) sums[c] += weights[abs(k - RADIUS)] * values[c + k];
    }
}

vec4 filtered_pixel(ivec2 pixel, ivec2 size, vec4 mean) {
    float alpha = COVERAGE ? mean.a : load(pixel, size, covered_bits_of(pixel.y)).a;
    return alpha > 0.0 ? over_background(mean.rgb / mean.a, alpha) : frame.background;
}

void main() {
    ivec2 size = ivec2(frame.viewport), first = ivec2(COLUMNS, BLOCK_ROWS) * ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(first, size))) return;
    find_covered_tiles(first);
    for (int k = 0; k <= RADIUS; k++) weights[k] = exp(-0.5 / frame.pixel_filter * float(k * k));
    float across[COLUMNS];
    for (int c = 0; c < COLUMNS; c++) across[c] = total(first.x + c, size.x);
    vec4 rows[TAPS][COLUMNS];
    // Blocks without covered tiles keep the background. Not a branch: lavapipe only masks these, but skips loops.
    int last = covered_bits != 0 ? min(first.y + BLOCK_ROWS, size.y) + RADIUS : first.y - RADIUS;
    for (int row = first.y - RADIUS; row < last; row++) {
        for (int k = 1; k < TAPS; k++) rows[k - 1] = rows[k];
        sum_row(ivec2(first.x, row), size, rows[TAPS - 1]);
        int y = row - RADIUS;
        if (y < first.y) continue;
        float down = total(y, size.y);
        for (int c = 0; c < COLUMNS; c++) {
            ivec2 pixel = ivec2(first.x + c, y);
            vec4 sum = vec4(0.0);
            for (int k = 0; k < TAPS; k++) sum += weights[abs(k - RADIUS)] * rows[k][c];
            if (pixel.x < size.x) imageStore(filtered, pixel, filtered_pixel(pixel, size, sum / (across[c] * down)));
        }
    }
}

#endif
