// Ambient occlusion in blocks of 2 × 2 pixels. The image `occlusion` has of each the part of the light from the hemisphere that is occluded;
// the distance, 0 without a surface; and the slope along x and y, in widths of a pixel per px.

// Radius within which surfaces occlude, px: a part of the picture's shorter side.
float occlusion_radius() {
    return 0.125 * min(frame.viewport.x, frame.viewport.y);
}

// The pixel of which a block has the values; those of neighbouring blocks are in different places of them.
ivec2 sampled_pixel(ivec2 block) {
    return min(2 * block + (block.yx & 1), picture_size() - 1);
}

// How far a surface at distance `other` is in front of one at distance `depth`, in widths of a pixel there: affine on the screen for a plane.
float rise(float depth, float other) {
    return (depth - other) / (frame.pixel_width * (PERSPECTIVE ? other : 1.0));
}
