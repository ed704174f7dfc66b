// Per-pixel buffers of the compute rasterizer, rows from the top left.

layout(set = 1, binding = 0, std430) buffer Visibility { uint visibility[]; }; // bits of κ: for κ ≥ 0 they order like κ
layout(set = 1, binding = 1, std430) buffer Sums0 { float sums0[]; };
layout(set = 1, binding = 2, std430) buffer Sums1 { float sums1[]; };
layout(set = 1, binding = 3, std430) writeonly buffer Picture { float picture[]; }; // colour, then normals, then depths
layout(set = 1, binding = 4, std430) buffer Tiles { uint tiles[]; }; // least visibility in each tile, empty pixels aside

// Side of a tile, px.
const uint TILE = 8;

uint pixel_index(ivec2 pixel) {
    return uint(pixel.y) * uint(frame.viewport.x) + uint(pixel.x);
}
