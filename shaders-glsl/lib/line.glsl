// A segment as points: one in every column of the picture that it reaches, or in every row where it is steeper (marroquim2008 §4.1, §4.2).
// What is wide is several strands side by side: src/verify/reference/pull_push/project/strands.rs says why.

const float WIDEST = 4.0;  // half the width up to which a line is one strand, px
const float SPREAD = 1.5; // by how much a ribbon's strands are wider than what they are a part of
const float MOST = 64.0;   // strands of a line
const float MARGIN = 16.0; // how far beyond the picture strands go on, px
const float PI = 3.14159265358979;

// An end of a segment, or of a strand: where it runs, and the disc that it is of. A tube's is about its axis, and faces the eye.
struct End {
    Vertex vertex;
    vec3 along;         // unit direction of the line
    vec3 run_hi, run_lo; // of a strand
    float run_distance;
};

struct Segment {
    End from, to;
    bool tube;
    int strands;
};

struct Strand {
    End from, to;
    vec2 start, extent; // of the run, px
    vec4 discs;         // where the discs of both ends are, px
    int steep;          // 1 if it is a point in every row, not in every column
    bool on_tube;       // it runs on a tube's surface, not along the axis
};

// A strand's point in a pixel.
struct Place {
    ivec2 at;
    float nearest;
    vec2 weights; // of the ends, in space
};

End end_of(uint i) {
    End end;
    end.vertex = vertex_of(i);
    end.along = vec3(alongs[3 * i], alongs[3 * i + 1], alongs[3 * i + 2]);
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
    end.run_hi = mix(a.run_hi, b.run_hi, t);
    end.run_lo = mix(a.run_lo, b.run_lo, t);
    end.run_distance = mix(a.run_distance, b.run_distance, t);
    return end;
}

vec3 unit_or(vec3 v, vec3 otherwise) {
    float size = dot(v, v);
    return size > 0.0 ? v * inversesqrt(size) : otherwise;
}

float half_width(Vertex v) {
    return focal_scale() * v.radius / (PERSPECTIVE ? v.distance : 1.0);
}

// The part of segment i beyond the near plane; false where there is none.
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
        cut.along = unit_or(cut.along, vec3(0.0));
        cut.vertex.distance = view.near;
        if (a < 0.0) s.from = cut;
        else s.to = cut;
    }
    float widest = max(half_width(s.from.vertex), half_width(s.to.vertex));
    if (!PAPER && widest > WIDEST) s.strands = int(min(ceil((s.tube ? 0.5 * PI : 1.0) * widest / WIDEST), MOST));
    return true;
}

void offset_run(inout End end, vec3 offset) {
    vec3 hi = end.vertex.hi, lo = end.vertex.lo;
    vec2 x = two_sum(hi.x, offset.x), y = two_sum(hi.y, offset.y), z = two_sum(hi.z, offset.z);
    end.run_hi = vec3(x.x, y.x, z.x);
    end.run_lo = lo + vec3(x.y, y.y, z.y);
    end.run_distance = distance_of(end.run_hi, end.run_lo);
}

// On a tube, at an angle from where it is nearest to the eye.
void stave(inout End end, vec3 line, float angle) {
    vec3 along = dot(end.along, line) < 0.0 ? -end.along : end.along;
    vec3 to_eye = PERSPECTIVE ? -normalize(end.vertex.hi) : -view.forward_hi.xyz;
    vec3 side = unit_or(cross(along, to_eye), vec3(0.0));
    offset_run(end, end.vertex.radius * (cos(angle) * cross(side, along) + sin(angle) * side));
}

vec3 across_of(End end, vec3 line) {
    vec3 along = dot(end.along, line) < 0.0 ? -end.along : end.along;
    return unit_or(cross(end.vertex.direction, along), vec3(0.0));
}

// At an offset across a ribbon, in half widths.
void lath(inout End from, inout End to, vec3 line, float offset, float part) {
    vec3 a = across_of(from, line), b = across_of(to, line);
    // Either side of a ribbon is its front.
    if (dot(a, b) < 0.0) b = -b;
    offset_run(from, offset * from.vertex.radius * a);
    offset_run(to, offset * to.vertex.radius * b);
    // Where a ribbon is twisted, its normal is not the middle line's.
    vec3 along = line + offset * (to.vertex.radius * b - from.vertex.radius * a);
    from.vertex.direction = unit_or(cross(along, a), from.vertex.direction);
    to.vertex.direction = unit_or(cross(along, b), to.vertex.direction);
    from.vertex.hi = from.run_hi, from.vertex.lo = from.run_lo, from.vertex.distance = from.run_distance;
    to.vertex.hi = to.run_hi, to.vertex.lo = to.run_lo, to.vertex.distance = to.run_distance;
    from.vertex.radius *= part;
    to.vertex.radius *= part;
}

// Leaves of a strand what is within MARGIN of the picture, as far as it can be seen: farther coordinates cost the others' digits.
bool cut_to_picture(inout End from, inout End to) {
    float first = 0.0, last = 1.0;
    for (int k = 0; k < 4; k++) {
        float side = (k & 1) == 0 ? -MARGIN : frame.viewport[k >> 1] + MARGIN;
        float inside = (k & 1) == 0 ? 1.0 : -1.0;
        float x0 = pixel_row(k >> 1, from.run_hi, from.run_lo).x, x1 = pixel_row(k >> 1, to.run_hi, to.run_lo).x;
        float w0 = PERSPECTIVE ? from.run_distance : 1.0, w1 = PERSPECTIVE ? to.run_distance : 1.0;
        float f0 = inside * (x0 - side * w0), f1 = inside * (x1 - side * w1);
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

// Strand k of a segment; false where it is not seen.
bool strand_of(Segment s, int k, out Strand strand) {
    strand.from = s.from;
    strand.to = s.to;
    strand.on_tube = s.tube && s.strands > 1;
    vec3 line = (s.to.vertex.hi - s.from.vertex.hi) + (s.to.vertex.lo - s.from.vertex.lo);
    float count = float(s.strands);
    if (strand.on_tube) {
        float angle = PI * ((float(k) + 0.5) / count - 0.5);
        stave(strand.from, line, angle);
        stave(strand.to, line, angle);
    } else if (s.strands > 1) {
        float part = SPREAD / count;
        lath(strand.from, strand.to, line, (1.0 - part) * (2.0 * float(k) / (count - 1.0) - 1.0), part);
    } else {
        offset_run(strand.from, vec3(0.0));
        offset_run(strand.to, vec3(0.0));
        strand.from.run_distance = s.from.vertex.distance;
        strand.to.run_distance = s.to.vertex.distance;
    }
    if (min(strand.from.run_distance, strand.to.run_distance) < view.near) return false;
    if (!cut_to_picture(strand.from, strand.to)) return false;
    strand.start = screen_of(strand.from.run_hi, strand.from.run_lo);
    strand.extent = screen_of(strand.to.run_hi, strand.to.run_lo) - strand.start;
    strand.steep = abs(strand.extent.y) > abs(strand.extent.x) ? 1 : 0;
    strand.discs.xy = screen_of(strand.from.vertex.hi, strand.from.vertex.lo);
    strand.discs.zw = screen_of(strand.to.vertex.hi, strand.to.vertex.lo);
    return true;
}

// First and last column, or row, that a strand reaches.
ivec2 columns_of(Strand s) {
    float a = s.start[s.steep], b = a + s.extent[s.steep];
    return ivec2(max(floor(min(a, b)), 0.0), min(floor(max(a, b)), frame.viewport[s.steep] - 1.0));
}

// The point of a strand in a column, or a row; false where it is not seen.
bool place_of(Segment segment, Strand s, int column, out Place place) {
    float extent = s.extent[s.steep];
    float t = extent != 0.0 ? clamp((float(column) + 0.5 - s.start[s.steep]) / extent, 0.0, 1.0) : 0.0;
    int across = 1 - s.steep;
    place.at[s.steep] = column;
    place.at[across] = int(floor(clamp(s.start[across] + t * s.extent[across], -1.0, frame.viewport[across])));
    place.weights = vec2(1.0 - t, t);
    if (PERSPECTIVE) place.weights /= vec2(s.from.run_distance, s.to.run_distance);
    place.weights /= place.weights.x + place.weights.y;
    float distance = dot(place.weights, vec2(s.from.run_distance, s.to.run_distance));
    float radius = dot(place.weights, vec2(s.from.vertex.radius, s.to.vertex.radius));
    // An axis is behind what is seen of its tube.
    bool is_axis = segment.tube && !s.on_tube && !PAPER;
    place.nearest = is_axis ? max(distance - radius, view.near) : distance;
    return place.at[across] >= 0 && place.at[across] < int(frame.viewport[across]) && !is_beyond_far(distance);
}

Sample sample_at(Segment segment, Strand s, Place place) {
    Vertex a = s.from.vertex, b = s.to.vertex;
    vec2 weights = place.weights;
    float distance = dot(weights, vec2(a.distance, b.distance));
    vec3 direction = weights.x * a.direction + weights.y * b.direction;
    // A ribbon shows the side that is seen; a tube's tangent has no sign.
    if (!segment.tube && facing_of(weights.x * a.hi + weights.y * b.hi, direction) > 0.0) direction = -direction;
    float radius = dot(weights, vec2(a.radius, b.radius));
    vec2 on_screen = PERSPECTIVE ? weights * vec2(a.distance, b.distance) / distance : weights;
    vec2 screen = on_screen.x * s.discs.xy + on_screen.y * s.discs.zw;
    Sample disc = disc_sample(vec2(place.at) + 0.5, screen, place.nearest, distance, radius, direction, segment.tube);
    disc.colour = weights.x * a.colour + weights.y * b.colour;
    disc.coordinates = weights.x * a.coordinates + weights.y * b.coordinates;
    return disc;
}
