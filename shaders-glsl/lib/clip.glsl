// Clip lines: where splats end at sharp edges and corners (zwicker2004 §5). On the screen a line of the tangent plane stays a line.

// Draws see none of this, unless they are compiled with CLIP_LINES: their fragments have no other buffer.
#if defined(COMPUTE) || defined(CLIP_LINES) || defined(COVERAGE)
#define SEES_CLIPS
#endif

#ifdef SEES_CLIPS
layout(constant_id = 23) const bool CLIPS = false;
#else
const bool CLIPS = false;
#endif
layout(constant_id = 24) const bool BEYOND_CLIPS = false; // α is coverage, and of a pixel that a line cuts either part may be covered

// How far beyond a line there are fragments then, px: as far as a pixel that it cuts can have its centre.
const float BEYOND = 0.70710678;
// Such a fragment is seen where there is no other: its κ counts for so much less that it is behind all that are not beyond a line.
const float BEHIND_ALL = 8.6736174e-19; // 2⁻⁶⁰

// Signed distances, px, at d px from the anchor: l.x + l.y d.x + l.z d.y is above 0 where the line keeps the splat. Each plane is
// (value, derivatives); a line that is not there keeps everything.
struct ScreenClip {
    vec4 first;  // .w: above 0 for a concave corner, which keeps what either line keeps
    vec4 second;
};

const vec4 NO_LINE = vec4(1e30, 0.0, 0.0, 0.0);

#if defined(SEES_CLIPS) && defined(TILE_PASS)
layout(set = 1, binding = 9, std430) readonly buffer FrameClips { ScreenClip screen_clips[]; };
#elif defined(SEES_CLIPS)
// The scene's: for every surfel of the window 0, or 1 + the number of its clip with CONCAVE if its corner is; then the clips, each two
// lines of outward (3 floats) and offset.
layout(set = 0, binding = 9, std430) readonly buffer Clips { uint clips[]; };
// The same on the screen, by the footprint pass.
layout(set = 0, binding = 10, std430) CLIP_ACCESS buffer ScreenClips { ScreenClip screen_clips[]; };
#endif

// A clip on the screen by its screen_clip_number.
ScreenClip screen_clip(uint number) {
#ifdef SEES_CLIPS
    return screen_clips[number];
#else
    return ScreenClip(NO_LINE, NO_LINE);
#endif
}

const uint CONCAVE = 0x80000000u;

#ifndef TILE_PASS
// Number of surfel i's clip in the window, or ~0 if its disc is whole.
uint clip_number(uint i) {
#ifdef SEES_CLIPS
    if (CLIPS) return (clips[i] & ~CONCAVE) - 1u;
#endif
    return ~0u;
}
#endif

#if !defined(FRAGMENT) && !defined(TILE_PASS)
// Where the instance has surfel i's clip on the screen, or ~0 if its disc is whole.
uint screen_clip_number(uint i) {
    uint number = clip_number(i);
    return number == ~0u ? number : instance_number() * window.clips + number;
}
#endif

bool has_clip(uint number) {
    return CLIPS && number < CONCAVE - 1u;
}

// Signed distance, px, of what is d px from the anchor to what is clipped: at least 0 where it is kept.
float clip_distance(ScreenClip clip, vec2 d) {
    float first = clip.first.x + dot(clip.first.yz, d);
    float second = clip.second.x + dot(clip.second.yz, d);
    return clip.first.w > 0.0 ? max(first, second) : min(first, second);
}

// What a fragment's κ is multiplied by where κ are compared, `distance` px from what is clipped; 0 where there is no fragment.
float clip_rank(float distance) {
    if (BEYOND_CLIPS && distance < 0.0 && distance >= -BEYOND) return BEHIND_ALL;
    return distance >= 0.0 ? 1.0 : 0.0;
}

// κ as it is compared.
float ranked(float key, float rank) {
    return BEYOND_CLIPS ? rank * key : key;
}
