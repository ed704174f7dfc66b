//! Segments of ribbons and tubes from edges and polylines.

use crate::formats::Lines;
use crate::formats::declared::{Element, Kind};
use crate::formats::table::Points;
use crate::geometry::Cloud;
use glam::Vec3;

/// Name of the property that marks tubes.
pub(super) const TUBE: &str = "tube";

/// Vertex properties of an element of lines, as indices.
#[derive(Clone, Copy)]
pub(super) enum Ends {
    /// Two scalars.
    Two([usize; 2]),
    /// A list, in which −1 starts another line.
    List(usize),
}

/// The vertex properties of an element of lines; `None` for other elements.
pub(super) fn ends(element: &Element) -> Option<Ends> {
    let scalar = |name: &str| scalar(element, name);
    let list = || {
        let is = |kind| matches!(kind, Kind::List { .. });
        let named = |name: &str| matches!(name, "vertex_indices" | "vertex_index");
        element.properties.iter().position(|property| named(&property.name) && is(property.kind))
    };
    match element.name.as_str() {
        "edge" => match (scalar("vertex1"), scalar("vertex2")) {
            (Some(a), Some(b)) => Some(Ends::Two([a, b])),
            _ => list().map(Ends::List),
        },
        "polyline" | "linestrips" => list().map(Ends::List),
        _ => None,
    }
}

/// Index of the scalar property with this name.
pub(super) fn scalar(element: &Element, name: &str) -> Option<usize> {
    let is = |kind| matches!(kind, Kind::Scalar(_));
    element.properties.iter().position(|property| property.name == name && is(property.kind))
}

/// A segment between points.
struct Segment {
    /// The lesser index first.
    ends: [u32; 2],
    /// Whether the file has the opposite order.
    turned: bool,
    tube: bool,
    /// Whether the file declares ribbon or tube, and not only an edge.
    declared: bool,
}

/// Collects segments between the points.
pub(super) struct Segments<'a> {
    points: &'a Points,
    all: Vec<Segment>,
    lines: Lines,
}

impl<'a> Segments<'a> {
    pub fn new(points: &'a Points) -> Self {
        Self { points, all: Vec::new(), lines: Lines::default() }
    }

    /// Adds the segments of a list; −1 starts another line.
    pub fn strip(&mut self, vertices: &[f64], tube: Option<bool>) {
        for line in vertices.split(|vertex| *vertex == -1.0) {
            for pair in line.windows(2) {
                self.add([pair[0], pair[1]], tube, true);
            }
        }
    }

    /// Adds an edge, which is a line unless it is the side of a face.
    pub fn edge(&mut self, vertices: [f64; 2], tube: Option<bool>) {
        self.add(vertices, tube, tube.is_some());
    }

    /// Adds a segment: a ribbon if both ends have normals, unless the file declares otherwise.
    fn add(&mut self, vertices: [f64; 2], tube: Option<bool>, declared: bool) {
        let cloud = &self.points.cloud;
        let [a, b] = vertices.map(|vertex| self.points.of_corner(vertex));
        let ends = a.zip(b).filter(|&(a, b)| cloud.positions[a as usize] != cloud.positions[b as usize]);
        let Some((a, b)) = ends else {
            self.lines.skipped += 1;
            return;
        };
        let normal = |i: u32| cloud.normals.as_ref().is_some_and(|normals| normals[i as usize] != Vec3::ZERO);
        let tube = tube == Some(true) || !(normal(a) && normal(b));
        self.all.push(Segment { ends: [a.min(b), a.max(b)], turned: b < a, tube, declared });
    }

    /// The lines of the segments, without the sides of `triangles`.
    pub fn finish(mut self, triangles: &[[u32; 3]]) -> (Cloud, Lines) {
        self.leave_out_sides(triangles);
        let mut found = Cloud::default();
        for Segment { ends: [a, b], turned, tube, .. } in self.all {
            let ends = if turned { [b, a] } else { [a, b] };
            if tube { &mut found.tubes } else { &mut found.ribbons }.push(ends);
            self.lines.understood += 1;
        }
        (found, self.lines)
    }

    fn leave_out_sides(&mut self, triangles: &[[u32; 3]]) {
        // There are few edges, but there may be many triangles.
        let mut undeclared: Vec<_> =
            self.all.iter().filter(|edge| !edge.declared).map(|edge| (edge.ends, false)).collect();
        if undeclared.is_empty() || triangles.is_empty() {
            return;
        }
        undeclared.sort_unstable();
        undeclared.dedup();
        for &[a, b, c] in triangles {
            for (a, b) in [(a, b), (b, c), (c, a)] {
                if let Ok(place) = undeclared.binary_search_by_key(&[a.min(b), a.max(b)], |(ends, _)| *ends) {
                    undeclared[place].1 = true;
                }
            }
        }
        let is_side = |edge: &Segment| {
            let place = undeclared.binary_search_by_key(&edge.ends, |(ends, _)| *ends);
            !edge.declared && place.is_ok_and(|place| undeclared[place].1)
        };
        let before = self.all.len();
        self.all.retain(|edge| !is_side(edge));
        self.lines.sides = (before - self.all.len()) as u64;
    }
}
