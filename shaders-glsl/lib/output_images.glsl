// Output images of compute passes; the picture is write-only unless the including pass defines another access.

layout(constant_id = 9) const bool OUT_NORMAL = false;
layout(constant_id = 10) const bool OUT_DEPTH = false;

#ifndef IMAGE_ACCESS
#define IMAGE_ACCESS writeonly
#endif
layout(set = 1, binding = 3, rgba32f) IMAGE_ACCESS uniform image2D image_output;
layout(set = 1, binding = 19, rgba32f) writeonly uniform image2D normal_output;
layout(set = 1, binding = 20, r32f) writeonly uniform image2D depth_output;

void store_outputs(ivec2 pixel, vec4 image, vec3 normal, float depth) {
    imageStore(image_output, pixel, image);
    if (OUT_NORMAL) imageStore(normal_output, pixel, vec4(normal, 0.0));
    if (OUT_DEPTH) imageStore(depth_output, pixel, vec4(depth));
}
