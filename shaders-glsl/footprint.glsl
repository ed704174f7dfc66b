// Footprint: projects each surfel to a splat, culls it and counts cull reasons (zwicker2004 §4).
#version 450
#pragma variant TILES COMPUTE
#extension GL_GOOGLE_include_directive : require

#ifdef TILES
#define VISIBLE_ACCESS readonly
#define PER_CLUSTER
#include "lib/visible_clusters.glsl"
#endif
#include "lib/instance.glsl"
#define WRITES_SPLATS
#define CLIP_ACCESS writeonly
#include "lib/splat.glsl"
#ifdef TILES
#include "lib/box.glsl"
#include "lib/sums.glsl"
#include "lib/surfel_attributes.glsl"
#include "lib/surfel_weights.glsl"
#include "lib/surfel_normal_field.glsl"
#include "lib/attributes.glsl"
#else
#include "lib/surfel_normal.glsl"
#endif
#define ORDER_ACCESS readonly
#include "lib/order.glsl"
#include "lib/image.glsl"
#include "lib/pixel_row.glsl"
#include "lib/tangents.glsl"

#ifdef COMPUTE

#include "lib/cull_reasons.glsl"
#include "lib/levels.glsl"

layout(local_size_x = 64) in;

layout(constant_id = 1) const bool CULL_BACK = false;
layout(constant_id = 68) const bool CULL_AUTO = false; // pass sides culls some splats that face away
layout(constant_id = 49) const bool UNORDERED = false; // splats are in another order than surfels: lib/order.glsl
layout(constant_id = 21) const bool MOVED = false; // splats of discs moved away from the eye by ε along the camera's axis

// Least q, relative to (w / F)²: nearer to the eye plane, rounding destroys the ellipse's position.
const float LEAST_CLEARANCE = 1e-3;
// Least √|V|, px², whose weight is above 0: a smaller splat would occlude and contribute nothing.
const float LEAST_AREA = 1e-30;
// Largest variance, px².
const float LARGEST_VARIANCE = 1e30;

// κ of the plane n·x = h at the anchor, and its derivatives. At grazing angles κ is a small difference of large terms.
mat2x3 depth_plane(vec3 n, vec2 h, vec2 facing, vec2 anchor) {
    vec2 x = dot_double(n, vec3(0.0), view.ray_hi[0].xyz, view.ray_lo[0].xyz);
    vec2 y = dot_double(n, vec3(0.0), view.ray_hi[1].xyz, view.ray_lo[1].xyz);
    vec2 key = dot_double(n, vec3(0.0), view.ray_hi[2].xyz, view.ray_lo[2].xyz);
    key = add(key, add(scale(x, anchor.x), scale(y, anchor.y)));
    if (!PERSPECTIVE) key = add(key, scale(h, -view.key_slope));
    key = divide(key, facing);
    x = divide(x, facing);
    y = divide(y, facing);
    if (DISTANT) key = add(key, -frame.key_offset);
    return mat2x3(vec3(key.x, x.x, y.x), vec3(key.y, x.y, y.y));
}

// κ of a disc's nearest point, which is `lean` nearer than its centre.
float key_of_disc(Disc disc, float lean) {
    float distance = PERSPECTIVE ? counted_distance(disc.w).x : dot(view.forward_hi.xyz, disc.hi);
    return key_at_distance(distance - lean);
}

// Depth below its centre down to which the disc of a front-facing convex surface covers samples, relative to the radius of curvature and to
// the cosine between normal and viewing ray: of circles, and of ellipses. At grazing angles the tangent plane of a sphere leaves its outline at
// the depth of ellipses, which are of triangles and hardly overlap; circles overlap, and pictures of scans are nearest to the truth with half.
const float TURN_DEPTH[2] = {0.25, 0.5};

// See least_key; 0 where the surface does not turn away.
float least_key_of(uint i, Disc disc) {
    uint stored = curvature_of(i);
    if (stored == 0 || disc.facing.x >= 0.0 || is_billboard(i)) return 0.0;
    float distance = PERSPECTIVE ? length(disc.hi) : 1.0;
    vec3 ray = PERSPECTIVE ? disc.hi / distance : view.forward_hi.xyz;
    // Down the tangent plane, as the eye sees it.
    float curvature = curvature_along(stored, ray * tangents(disc.normal));
    if (!(curvature > 0.0)) return 0.0;
    bool is_ellipse = ELLIPSES && ellipse_of(i).w < 1.0;
    float depth = TURN_DEPTH[uint(is_ellipse)] * -disc.facing.x / distance / curvature, key = key_of_disc(disc, 0.0);
    return PERSPECTIVE ? farther_key(key, depth / distance) : key - view.key_slope * depth;
}

// κ (has_linear_depth: distance) at the anchor, and its derivatives, of a plane that is not the tangent plane; `to_centre` is in px.
mat2x3 flat_plane(Disc disc, vec2 slope, vec2 to_centre) {
    vec2 value = counted_distance(disc.w);
    if (PERSPECTIVE && !has_linear_depth()) value = vec2(key_at_distance(value.x), 0.0);
    if (!PERSPECTIVE) {
        vec2 z = dot_double(disc.hi, disc.lo, view.forward_hi.xyz, view.forward_lo.xyz);
        value = add(two_sum(1.0, view.near * view.key_slope), scale(z, -view.key_slope));
    }
    value = add(value, -two_product(slope.x, to_centre.x));
    value = add(value, -two_product(slope.y, to_centre.y));
    return mat2x3(vec3(value.x, slope), vec3(value.y, 0.0, 0.0));
}

// Projects a line of the tangent plane, outward·(x − centre) = offset, to the screen: see ScreenClip. Near the line the value is a small
// difference of large terms.
vec4 project_clip_line(Disc disc, vec2 anchor, vec3 outward, float offset) {
    if (outward == vec3(0.0)) return NO_LINE;
    // n·x = h of plane and half space, and their products with the rays: values at the anchor, derivatives along x and y.
    vec2 reach = add(vec2(offset, 0.0), dot_double(disc.hi, disc.lo, outward, vec3(0.0)));
    vec2 plane[3], half_space[3];
    for (int i = 0; i < 3; i++) {
        plane[i] = dot_double(disc.normal, vec3(0.0), view.ray_hi[i].xyz, view.ray_lo[i].xyz);
        half_space[i] = dot_double(outward, vec3(0.0), view.ray_hi[i].xyz, view.ray_lo[i].xyz);
    }
    plane[2] = add(plane[2], add(scale(plane[0], anchor.x), scale(plane[1], anchor.y)));
    half_space[2] = add(half_space[2], add(scale(half_space[0], anchor.x), scale(half_space[1], anchor.y)));
    // For h > 0, a ray that meets the plane at h / n·ray satisfies outward·x ≤ reach where reach n·ray − h outward·ray ≥ 0.
    vec2 of_plane = reach, of_half_space = disc.h;
    if (!PERSPECTIVE) {
        // Parallel rays share a direction and differ in origin.
        of_plane = dot_double(outward, vec3(0.0), view.forward_hi.xyz, view.forward_lo.xyz);
        of_half_space = disc.facing;
        plane[2] = add(plane[2], -scale(disc.h, view.key_slope));
        half_space[2] = add(half_space[2], -scale(reach, view.key_slope));
    }
    vec3 line;
    for (int i = 0; i < 3; i++) {
        line[(i + 1) % 3] = add(multiply(of_plane, plane[i]), -multiply(of_half_space, half_space[i])).x;
    }
    float sign_of_h = disc.facing.x < 0.0 ? -1.0 : 1.0;
    float slope = length(line.yz);
    return slope > 0.0 ? vec4(sign_of_h / slope * line, 0.0) : NO_LINE;
}

// Writes the screen-space clip of surfel i, whose splat has this anchor.
void store_screen_clip(uint i, Disc disc, vec2 anchor) {
    uint index = clip_index(i);
    if (!has_clip(index)) return;
    vec4 lines[2];
    for (uint k = 0; k < 2; k++) {
        uint at = chunk.capacity + 8 * index + 4 * k;
        vec3 outward = uintBitsToFloat(uvec3(clips[at], clips[at + 1], clips[at + 2]));
        lines[k] = project_clip_line(disc, anchor, outward, uintBitsToFloat(clips[at + 3]));
    }
    lines[0].w = (clips[i] & CONCAVE) != 0u ? 1.0 : 0.0;
    screen_clips[screen_clip_index(i)] = ScreenClip(lines[0], lines[1]);
}

// Major axis and aspect of surfel i's disc, which has the normal n; without ellipses, those of a circle of any axis.
vec4 shape_of(uint i, vec3 n) {
    if (!ELLIPSES) return vec4(vec3(0.0), 1.0);
    return is_billboard(i) ? vec4(tangents(n)[0], 1.0) : ellipse_of(i);
}

// Loads surfel i relative to the eye; returns the cull reason so far.
uint load_disc(uint i, out Disc disc) {
    if (!is_valid(i)) return INVALID;
    vec3 p = position_of(i), n = normal_of(i);
    if (HAS_LEVELS && !is_of_drawn_level(chunk.first_id + i, p)) return LEVEL;
    float r = radius_of(i);
    vec4 shape = shape_of(i, n);
    disc.normal = n;
    disc.radius = r;
    disc.aspect = shape.w;
    disc.major = shape.xyz;
    disc.billboard = is_billboard(i);
    disc.axes = ELLIPSES ? ellipse_axes(n, shape) : tangents(n);

    // Position relative to the eye, homogeneous pixel and the plane's h = n·position, in twice the precision: everything below is relative
    // to these.
    vec2 dx = two_sum(p.x, -view.eye_hi.x), dy = two_sum(p.y, -view.eye_hi.y), dz = two_sum(p.z, -view.eye_hi.z);
    if (MOVED) {
        vec3 back = frame.epsilon * r * view.forward_hi.xyz;
        dx = add(dx, vec2(back.x, 0.0));
        dy = add(dy, vec2(back.y, 0.0));
        dz = add(dz, vec2(back.z, 0.0));
    }
    disc.hi = vec3(dx.x, dy.x, dz.x);
    disc.lo = vec3(dx.y, dy.y, dz.y) - view.eye_lo.xyz;
    disc.w = PERSPECTIVE ? pixel_row(2, disc.hi, disc.lo) : vec2(1.0, 0.0);
    // Here and below, values may be NaN where positions are too large for the view.
    if (!is_number(disc.w.x) || disc.w.x <= 0.0) return BEHIND;
    disc.h = dot_double(disc.hi, disc.lo, n, vec3(0.0));
    disc.facing = PERSPECTIVE ? disc.h : dot_double(n, vec3(0.0), view.forward_hi.xyz, view.forward_lo.xyz);
    return DRAWN;
}

// Centre of the ellipse relative to the anchor, px, rounded once.
vec2 fine_offset(Disc disc, Conic conic, vec2 anchor) {
    vec2 x = divide(add(disc.x, scale(disc.w, -anchor.x)), disc.w);
    vec2 y = divide(add(disc.y, scale(disc.w, -anchor.y)), disc.w);
    return vec2(add(x, vec2(conic.offset.x, conic.offset_lo.x)).x, add(y, vec2(conic.offset.y, conic.offset_lo.y)).x);
}

uint footprint(uint i, out Splat splat) {
    Disc disc;
    uint reason = load_disc(i, disc);
    if (reason != DRAWN) return reason;
    float sigma = disc.radius / frame.cutoff;
    vec3 S = sigma * to_pixel(disc.axes[0]);
    vec3 T = sigma * to_pixel(disc.axes[1]);
    float w = disc.w.x / frame.cutoff;
    if (FOOTPRINT != POINT) {
        float clear = clearance(disc, S, T);
        if (!is_number(clear) || clear <= LEAST_CLEARANCE * w * w) return EYE_PLANE;
    }
    if (CULL_BACK && disc.facing.x >= 0.0 && !is_two_sided(i)) return BACK;

    disc.x = pixel_row(0, disc.hi, disc.lo);
    disc.y = pixel_row(1, disc.hi, disc.lo);
    Image image = image_of(disc, sigma, S, T);
    vec2 reach = largest_stretch() * half_extent(image.conic.axis, attribute_variance(image.conic.variance));
    vec2 centre = vec2(disc.x.x, disc.y.x) / disc.w.x + image.conic.offset;
    vec2 low = centre - reach, high = centre + reach;
    bool inside = are_numbers(vec4(low, high)) && all(lessThanEqual(low, frame.viewport)) && all(greaterThanEqual(high, vec2(0.0)));
    if (!inside || !is_number(image.sqrt_det) || image.sqrt_det < LEAST_AREA) return OUTSIDE;
    if (!is_number(image.conic.variance.x) || image.conic.variance.x > LARGEST_VARIANCE) return INVALID;

    uvec2 pixel = uvec2(clamp(centre, vec2(0.0), frame.viewport - 1.0));
    vec2 anchor = vec2(pixel) + 0.5;
    vec2 to_centre = vec2(add(disc.x, scale(disc.w, -anchor.x)).x, add(disc.y, scale(disc.w, -anchor.y)).x) / disc.w.x;
    splat.offset = CONFETTI ? fine_offset(disc, image.conic, anchor) : to_centre + image.conic.offset;
    splat.axis = image.conic.axis;
    splat.variance = image.conic.variance.x;
    splat.detail = CURVATURES ? least_key_of(i, disc) : image.conic.axis_residual;
    splat.anchor = pack_anchor(pixel);
    if (CULL_AUTO && disc.facing.x >= 0.0 && !is_two_sided(i)) splat.anchor |= BACK_SPLAT;
    float epsilon = MOVED ? 0.0 : frame.epsilon * disc.radius;
    splat.epsilon = PERSPECTIVE ? disc.w.x / (disc.w.x + epsilon) : view.key_slope * epsilon;
    if (DISTANT) splat.epsilon = max(epsilon / (disc.w.x + epsilon), 1e-30);
    if (disc.facing.x > 0.0) splat.epsilon = -splat.epsilon;
    bool tangent = !is_sprite() && FOOTPRINT != SQUARE && FOOTPRINT != POINT;
    mat2x3 plane = tangent ? depth_plane(disc.normal, disc.h, disc.facing, anchor) : flat_plane(disc, image.slope, to_centre);
    splat.plane_hi = plane[0];
    splat.plane_lo = plane[1];
    store_screen_clip(i, disc, anchor);
    splat.sqrt_det = image.sqrt_det;
    splat.key_disc = key_of_disc(disc, image.lean);
    return DRAWN;
}

#ifdef TILES

// The tile path needs bounding boxes of splats and the attributes that sums read.
layout(set = 0, binding = 19, std430) writeonly buffer SplatBoxes { Box splat_boxes[]; };
layout(set = 0, binding = 7, std430) writeonly buffer SplatAttributes { vec4 splat_attributes[]; };

// Bounding box of the fragments of surfel i's splat.
Box box_of_splat(uint i, Splat splat) {
    vec2 variance = attribute_variance(variance_of(splat));
    float stretch = stretch_of(splat, variance, centre_key(splat.plane_hi, splat.plane_lo, splat.offset));
    vec2 reach = stretch * half_extent(splat.axis, variance);
    vec2 attribute0 = anchor_of(splat) + splat.offset - 0.5;
    ivec2 low = ivec2(max(ceil(attribute0 - reach), vec2(0.0)));
    ivec2 high = ivec2(min(floor(attribute0 + reach), frame.viewport - 1.0));
    float nearest = shown_key(nearest_of(splat, variance, stretch), splat.key_disc);
    if (any(greaterThan(low, high)) || nearest <= frame.key_far) return EMPTY_BOX;
    uint clip = screen_clip_index(i);
    Box box = box_of(low, high, least_tested(nearest), has_clip(clip) ? chunk.first_clip + clip : NO_CLIP);
    if (is_back(splat)) box.y |= BACK_BOX;
    return box;
}

void store_attributes(uint entry, uint i, Splat splat) {
    uint k = chunk.attribute_rows * splat_index(entry);
    vec4 corners;
    mat2 square;
    vec3 attribute0, attribute1;
    float weight = surfel_weight(i, splat, corners, square);
    surfel_attributes(i, splat.epsilon, attribute0, attribute1);
    if (WIDE_SUMS0 || FRAME_WEIGHTS) splat_attributes[k] = vec4(attribute0, weight);
    if (WIDE_SUMS1) splat_attributes[k + 1] = vec4(attribute1, 0.0);
    if (FRAME_NORMAL_FIELDS) splat_attributes[k + FIELD_ROW] = stored_field(attribute0, normal_field(i, splat));
    if (FRAME_CORNERS) {
        splat_attributes[k + ATTRIBUTE_ROWS - 2] = corners;
        splat_attributes[k + ATTRIBUTE_ROWS - 1] = vec4(square[0], -square[1].x * square[0].y + square[1].y * square[0].x, 0.0);
    }
}

// Surfel of an entry in the order of the chunk's surfels, in which splats of neighbours are neighbours.
uint surfel_of(uint entry) {
    return UNORDERED ? order[entry] : entry;
}

// Stores the result of surfel i, which has this entry.
void store(uint entry, uint i, uint reason, Splat splat) {
    uint index = splat_index(entry);
    splat_boxes[index] = reason == DRAWN ? box_of_splat(i, splat) : EMPTY_BOX;
    if (reason == DRAWN) {
        store_attributes(entry, i, splat);
        // Frame lists hold distances in the world's unit.
        if (INSTANCED && has_linear_depth()) scale_plane(view.scale, splat.plane_hi, splat.plane_lo);
        store_splat(index, splat);
    } else {
        store_culled(index);
    }
}

// Whether an entry has a surfel. Marks the padding of the list as empty.
bool has_surfel(uint entry) {
    bool exists = entry < chunk.count && instance_index() < chunk.instance_count;
    if (!exists && entry < chunk.instance_stride) splat_boxes[splat_index(entry)] = EMPTY_BOX;
    return exists;
}

#else

uint surfel_of(uint entry) {
    return entry;
}

uint entry_of_invocation() {
    return gl_GlobalInvocationID.x;
}

void store(uint entry, uint i, uint reason, Splat splat) {
    store_splat(splat_index(entry), splat);
}

bool has_surfel(uint entry) {
    return entry < chunk.count;
}

#endif

void main() {
    uint entry = entry_of_invocation();
    if (!has_surfel(entry)) return;
    uint i = surfel_of(entry);
    Splat splat = Splat(vec2(0.0), vec2(1.0, 0.0), 1.0, 0.0, 0, 0.0, vec3(0.0), 0.0, vec3(0.0), 0.0);
    uint reason = footprint(i, splat);
    store(entry, i, reason, splat);
    count(reason);
}

#endif
