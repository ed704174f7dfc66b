// Workgroups of passes over pixels: an invocation per pixel, as many as in src/frame/recording.rs.

layout(local_size_x = 16, local_size_y = 4) in;

ivec2 invocation_pixel() {
    return ivec2(gl_GlobalInvocationID.xy);
}

ivec2 picture_size() {
    return ivec2(frame.viewport);
}
