// Clip lines: bound splats at sharp edges and corners (zwicker2004 §5). A line of the tangent plane projects to a line on the screen.

// Raster pipelines read clips only if compiled with CLIP_LINES or COVERAGE: other fragment shaders have no buffers.
#if defined(COMPUTE) || defined(CLIP_LINES) || defined(COVERAGE)
#define READS_CLIPS
#endif

#ifdef READS_CLIPS
layout(constant_id = 23) const bool CLIPS = false;
#else
const bool CLIPS = false;
#endif
layout(constant_id = 24) const bool BEYOND_CLIPS = false; // α is coverage: in a pixel that a line cuts, either part may be covered

// Distance beyond a line up to which fragments exist then, px: the largest from the centre of a pixel to a line that cuts it.
const float BEYOND = 0.70710678;
// Factor of their κ, so that they are behind all fragments that are not beyond a line: they are visible only if the pixel has no other.
const float BEHIND_ALL = 8.6736174e-19; // 2⁻⁶⁰

// Signed distances, px, as planes (value, derivatives): l.x + l.y d.x + l.z d.y at d px from the anchor, above 0 where the line keeps the
// splat. An absent line keeps everything.
struct ScreenClip {
    vec4 first;  // .w: above 0 for a concave corner, which keeps the union of both half planes
    vec4 second;
};

const vec4 NO_LINE = vec4(1e30, 0.0, 0.0, 0.0);

#if defined(READS_CLIPS) && defined(SUBGROUPS)
layout(set = 1, binding = 22) uniform utextureBuffer clip_texels; // bits of the two lines of each clip
#elif defined(READS_CLIPS) && defined(TILE_PASS)
layout(set = 1, binding = 9, std430) readonly buffer FrameClips { ScreenClip screen_clips[]; };
#elif defined(READS_CLIPS)
// Of the scene: for every surfel of the chunk 0, or 1 + the index of its clip, with CONCAVE for a concave corner; then the clips, each two
// lines of outward (3 floats) and offset.
layout(set = 0, binding = 9, std430) readonly buffer Clips { uint clips[]; };
// Projected by the footprint pass.
layout(set = 0, binding = 10, std430) CLIP_ACCESS buffer ScreenClips { ScreenClip screen_clips[]; };
#endif

// The projected clip with this screen_clip_index.
ScreenClip screen_clip(uint index) {
#if defined(READS_CLIPS) && defined(SUBGROUPS)
    int i = int(2 * index);
    return ScreenClip(uintBitsToFloat(texelFetch(clip_texels, i)), uintBitsToFloat(texelFetch(clip_texels, i + 1)));
#elif defined(READS_CLIPS)
    return screen_clips[index];
#else
    return ScreenClip(NO_LINE, NO_LINE);
#endif
}

const uint CONCAVE = 0x80000000u;

#ifndef TILE_PASS
// Index of surfel i's clip in the chunk, or ~0 if it has none.
uint clip_index(uint i) {
#ifdef READS_CLIPS
    if (CLIPS) return (clips[i] & ~CONCAVE) - 1u;
#endif
    return ~0u;
}
#endif

#if !defined(FRAGMENT) && !defined(TILE_PASS)
// Index of surfel i's projected clip, or ~0 if it has none.
uint screen_clip_index(uint i) {
    uint index = clip_index(i);
    return index == ~0u ? index : instance_index() * chunk.clip_stride + index;
}
#endif

bool has_clip(uint index) {
    return CLIPS && index < CONCAVE - 1u;
}

// Signed distance, px, of a point d px from the anchor to the clip: at least 0 where the splat is kept.
float clip_distance(ScreenClip clip, vec2 d) {
    float first = clip.first.x + dot(clip.first.yz, d);
    float second = clip.second.x + dot(clip.second.yz, d);
    return clip.first.w > 0.0 ? max(first, second) : min(first, second);
}

// Factor of a fragment's κ in depth tests, `distance` px from the clip; 0 if the fragment is clipped.
float clip_rank(float distance) {
    if (BEYOND_CLIPS && distance < 0.0 && distance >= -BEYOND) return BEHIND_ALL;
    return distance >= 0.0 ? 1.0 : 0.0;
}

// κ for depth tests: above 0, which marks empty pixels.
float ranked(float key, float rank) {
    key = least_tested(key);
    return BEYOND_CLIPS ? rank * key : key;
}
