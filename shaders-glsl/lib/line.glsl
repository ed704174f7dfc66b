// A segment as points: one per pixel column that it crosses, or per row if it is steep (marroquim2008 §4.1, §4.2). Wide segments are
// divided into strands side by side: see src/verify/reference/pull_push/project/strands.rs.

const float WIDEST = 4.0;        // greatest half width of a line that is one strand, px
const float SPREAD = 1.5;        // factor that widens the strands of a ribbon
const float MOST_STRANDS = 64.0; // most strands of a line
const float MARGIN = 16.0;       // distance beyond the viewport at which strands are clipped, px
const float PI = 3.14159265358979;

// An end of a segment or strand: the middle line, and the disc. A tube's disc is around its axis and faces the eye.
struct End {
    Vertex vertex;
    vec3 along;            // unit direction of the line
    vec3 line_hi, line_lo; // middle line of a strand, relative to the eye
    float line_distance;
};

struct Segment {
    End from, to;
    bool tube;
    int strands;
};

struct Strand {
    End from, to;
    vec2 start, extent; // of the middle line, px
    vec4 disc_centres;  // centres of both ends' discs, px
    int steep;          // 1 if it has a point per row, not per column
    bool on_tube;       // the middle line lies on the tube's surface, not on its axis
};

// Point of a strand in a pixel.
struct StrandPoint {
    ivec2 pixel;
    float nearest;
    vec2 weights; // of the ends, in world space
};

End end_of(uint i) {
    End end;
    end.vertex = vertex_of(i);
    end.along = vec3(line_directions[3 * i], line_directions[3 * i + 1], line_directions[3 * i + 2]);
    return end;
}

End between(End a, End b, float t) {
    End end;
    end.vertex.hi = mix(a.vertex.hi, b.vertex.hi, t);
    end.vertex.lo = mix(a.vertex.lo, b.vertex.lo, t);
    end.vertex.direction = mix(a.vertex.direction, b.vertex.direction, t);
    end.vertex.radius = mix(a.vertex.radius, b.vertex.radius, t);
    end.vertex.distance = mix(a.vertex.distance, b.vertex.distance, t);
    end.vertex.colour = mix(a.vertex.colour, b.vertex.colour, t);
    end.vertex.coordinates = mix(a.vertex.coordinates, b.vertex.coordinates, t);
    end.along = mix(a.along, b.along, t);
    end.line_hi = mix(a.line_hi, b.line_hi, t);
    end.line_lo = mix(a.line_lo, b.line_lo, t);
    end.line_distance = mix(a.line_distance, b.line_distance, t);
    return end;
}

vec3 normalize_or(vec3 v, vec3 fallback) {
    float size = dot(v, v);
    return size > 0.0 ? v * inversesqrt(size) : fallback;
}

float half_width(Vertex v) {
    return focal_scale() * v.radius / (PERSPECTIVE ? from_eye(v.distance) : 1.0);
}

// Loads the part of segment i beyond the near plane; false if there is none.
bool segment_of(uint i, out Segment s) {
    uint first = elements[2 * i];
    s.tube = first >> 31 != 0;
    s.from = end_of(first & 0x7fffffffu);
    s.to = end_of(elements[2 * i + 1]);
    s.strands = 1;
    float a = s.from.vertex.distance - view.near, b = s.to.vertex.distance - view.near;
    if (!(min(s.from.vertex.radius, s.to.vertex.radius) >= 0.0) || !(max(a, b) >= 0.0)) return false;
    if (min(a, b) < 0.0) {
        End cut = between(s.from, s.to, a / (a - b));
        cut.along = normalize_or(cut.along, vec3(0.0));
        cut.vertex.distance = view.near;
        if (a < 0.0) s.from = cut;
        else s.to = cut;
    }
    float widest = max(half_width(s.from.vertex), half_width(s.to.vertex));
    if (!PAPER && widest > WIDEST) s.strands = int(min(ceil((s.tube ? 0.5 * PI : 1.0) * widest / WIDEST), MOST_STRANDS));
    return true;
}

void offset_line(inout End end, vec3 offset) {
    vec3 hi = end.vertex.hi, lo = end.vertex.lo;
    vec2 x = two_sum(hi.x, offset.x), y = two_sum(hi.y, offset.y), z = two_sum(hi.z, offset.z);
    end.line_hi = vec3(x.x, y.x, z.x);
    end.line_lo = lo + vec3(x.y, y.y, z.y);
    end.line_distance = distance_of(end.line_hi, end.line_lo);
}

// Moves the middle line to a tube's surface, at an angle from its point nearest to the eye.
void tube_strand(inout End end, vec3 line, float angle) {
    vec3 along = dot(end.along, line) < 0.0 ? -end.along : end.along;
    vec3 to_eye = PERSPECTIVE ? -normalize(end.vertex.hi) : -view.forward_hi.xyz;
    vec3 side = normalize_or(cross(along, to_eye), vec3(0.0));
    offset_line(end, end.vertex.radius * (cos(angle) * cross(side, along) + sin(angle) * side));
}

vec3 ribbon_side(End end, vec3 line) {
    vec3 along = dot(end.along, line) < 0.0 ? -end.along : end.along;
    return normalize_or(cross(end.vertex.direction, along), vec3(0.0));
}

// Moves ends to a strand of a ribbon at an offset across it, in half widths; its half width is `part` of the ribbon's.
void ribbon_strand(inout End from, inout End to, vec3 line, float offset, float part) {
    vec3 a = ribbon_side(from, line), b = ribbon_side(to, line);
    // Both sides of a ribbon are fronts.
    if (dot(a, b) < 0.0) b = -b;
    offset_line(from, offset * from.vertex.radius * a);
    offset_line(to, offset * to.vertex.radius * b);
    // The normal of a twisted ribbon changes across it.
    vec3 along = line + offset * (to.vertex.radius * b - from.vertex.radius * a);
    from.vertex.direction = normalize_or(cross(along, a), from.vertex.direction);
    to.vertex.direction = normalize_or(cross(along, b), to.vertex.direction);
    from.vertex.hi = from.line_hi, from.vertex.lo = from.line_lo, from.vertex.distance = from.line_distance;
    to.vertex.hi = to.line_hi, to.vertex.lo = to.line_lo, to.vertex.distance = to.line_distance;
    from.vertex.radius *= part;
    to.vertex.radius *= part;
}

// Clips a strand to the viewport, widened by MARGIN; false if nothing is left. Farther coordinates would lose digits.
bool clip_to_viewport(inout End from, inout End to) {
    float first = 0.0, last = 1.0;
    for (int k = 0; k < 4; k++) {
        float side = (k & 1) == 0 ? -MARGIN : frame.viewport[k >> 1] + MARGIN;
        float sign = (k & 1) == 0 ? 1.0 : -1.0;
        float x0 = pixel_row(k >> 1, from.line_hi, from.line_lo).x, x1 = pixel_row(k >> 1, to.line_hi, to.line_lo).x;
        float w0 = PERSPECTIVE ? from_eye(from.line_distance) : 1.0, w1 = PERSPECTIVE ? from_eye(to.line_distance) : 1.0;
        float f0 = sign * (x0 - side * w0), f1 = sign * (x1 - side * w1);
        if (max(f0, f1) < 0.0) return false;
        if (f0 < 0.0) first = max(first, f0 / (f0 - f1));
        if (f1 < 0.0) last = min(last, f0 / (f0 - f1));
    }
    if (first > last) return false;
    End a = from, b = to;
    if (first > 0.0) from = between(a, b, first);
    if (last < 1.0) to = between(a, b, last);
    return true;
}

// Strand k of a segment; false if it is not visible.
bool strand_of(Segment s, int k, out Strand strand) {
    strand.from = s.from;
    strand.to = s.to;
    strand.on_tube = s.tube && s.strands > 1;
    vec3 line = (s.to.vertex.hi - s.from.vertex.hi) + (s.to.vertex.lo - s.from.vertex.lo);
    float count = float(s.strands);
    if (strand.on_tube) {
        float angle = PI * ((float(k) + 0.5) / count - 0.5);
        tube_strand(strand.from, line, angle);
        tube_strand(strand.to, line, angle);
    } else if (s.strands > 1) {
        float part = SPREAD / count;
        ribbon_strand(strand.from, strand.to, line, (1.0 - part) * (2.0 * float(k) / (count - 1.0) - 1.0), part);
    } else {
        offset_line(strand.from, vec3(0.0));
        offset_line(strand.to, vec3(0.0));
        strand.from.line_distance = s.from.vertex.distance;
        strand.to.line_distance = s.to.vertex.distance;
    }
    if (min(strand.from.line_distance, strand.to.line_distance) < view.near) return false;
    if (!clip_to_viewport(strand.from, strand.to)) return false;
    strand.start = screen_of(strand.from.line_hi, strand.from.line_lo);
    strand.extent = screen_of(strand.to.line_hi, strand.to.line_lo) - strand.start;
    strand.steep = abs(strand.extent.y) > abs(strand.extent.x) ? 1 : 0;
    strand.disc_centres.xy = screen_of(strand.from.vertex.hi, strand.from.vertex.lo);
    strand.disc_centres.zw = screen_of(strand.to.vertex.hi, strand.to.vertex.lo);
    return true;
}

// First and last column, or row, that a strand crosses.
ivec2 columns_of(Strand s) {
    float a = s.start[s.steep], b = a + s.extent[s.steep];
    return ivec2(max(floor(min(a, b)), 0.0), min(floor(max(a, b)), frame.viewport[s.steep] - 1.0));
}

// The point of a strand in a column, or a row; false if it is not visible.
bool strand_point(Segment segment, Strand s, int column, out StrandPoint point) {
    float extent = s.extent[s.steep];
    float t = extent != 0.0 ? clamp((float(column) + 0.5 - s.start[s.steep]) / extent, 0.0, 1.0) : 0.0;
    int across = 1 - s.steep;
    point.pixel[s.steep] = column;
    point.pixel[across] = int(floor(clamp(s.start[across] + t * s.extent[across], -1.0, frame.viewport[across])));
    point.weights = vec2(1.0 - t, t);
    if (PERSPECTIVE) point.weights /= vec2(from_eye(s.from.line_distance), from_eye(s.to.line_distance));
    point.weights /= point.weights.x + point.weights.y;
    float distance = dot(point.weights, vec2(s.from.line_distance, s.to.line_distance));
    float radius = dot(point.weights, vec2(s.from.vertex.radius, s.to.vertex.radius));
    // The surface of a tube is in front of its axis.
    bool is_axis = segment.tube && !s.on_tube && !PAPER;
    point.nearest = is_axis ? max(distance - radius, view.near) : distance;
    return point.pixel[across] >= 0 && point.pixel[across] < int(frame.viewport[across]) && !is_beyond_far(distance);
}

Sample sample_at(Segment segment, Strand s, StrandPoint point) {
    Vertex a = s.from.vertex, b = s.to.vertex;
    vec2 weights = point.weights;
    float distance = dot(weights, vec2(a.distance, b.distance));
    vec3 direction = weights.x * a.direction + weights.y * b.direction;
    // A ribbon is two-sided; the tangent of a tube has no sign.
    if (!segment.tube && facing_of(weights.x * a.hi + weights.y * b.hi, direction) > 0.0) direction = -direction;
    float radius = dot(weights, vec2(a.radius, b.radius));
    vec2 on_screen = PERSPECTIVE ? weights * vec2(from_eye(a.distance), from_eye(b.distance)) / from_eye(distance) : weights;
    vec2 screen = on_screen.x * s.disc_centres.xy + on_screen.y * s.disc_centres.zw;
    Sample disc = disc_sample(vec2(point.pixel) + 0.5, screen, point.nearest, distance, radius, direction, segment.tube);
    disc.colour = weights.x * a.colour + weights.y * b.colour;
    disc.coordinates = weights.x * a.coordinates + weights.y * b.coordinates;
    return disc;
}
