//! Sharp edges of surfaces, and clip lines of the discs that reach them (Zwicker et al. 2004, section 5): a disc ends
//! where its plane intersects the tangent plane of the face beyond the edge.

use crate::geometry::{Clip, ClipLine};
use glam::DVec3;

/// Tolerance for equality of planes, unit normals and end points; scenes have a size of about 1.
const SAME: f64 = 1e-9;

/// An edge between two smooth faces.
#[derive(Clone, Copy, Debug)]
pub enum Edge {
    /// Straight, between two planes.
    Straight {
        /// End points.
        ends: [DVec3; 2],
        /// Outward unit normals of the faces.
        normals: [DVec3; 2],
        /// Whether the solid is the intersection of both half-spaces, not the union.
        convex: bool,
    },
    /// A circle in a plane: the rim of a round hole perpendicular to it, or that of a disc.
    Rim {
        /// Centre of the circle.
        centre: DVec3,
        /// Outward unit normal of the plane.
        normal: DVec3,
        /// Radius of the circle.
        radius: f64,
        /// Whether the plane's face is outside of it.
        hole: bool,
    },
}

impl Edge {
    /// The point of the edge nearest to `p`; none from a rim's axis.
    fn foot(&self, p: DVec3) -> Option<DVec3> {
        match *self {
            Self::Straight { ends: [from, to], .. } => {
                let along = to - from;
                let part = (p - from).dot(along) / along.length_squared();
                Some(from + part.clamp(0.0, 1.0) * along)
            }
            Self::Rim { centre, normal, radius, .. } => {
                Some(centre + radius * (p - centre).reject_from_normalized(normal).try_normalize()?)
            }
        }
    }

    /// Outward unit normals of the faces at a point of the edge, and whether the edge is convex.
    fn faces(&self, foot: DVec3) -> ([DVec3; 2], bool) {
        match *self {
            Self::Straight { normals, convex, .. } => (normals, convex),
            Self::Rim { centre, normal, hole, .. } => {
                let beyond = if hole { centre - foot } else { foot - centre };
                ([normal, beyond.normalize()], true)
            }
        }
    }

    /// The cut of a disc around `p` by the edge; `None` unless `p` is on one of the edge's faces, within reach.
    fn cut(&self, p: DVec3, normal: DVec3, radius: f64) -> Option<Cut<'_>> {
        let foot = self.foot(p)?;
        let distance = p.distance(foot);
        if distance > radius {
            return None;
        }
        let (normals, convex) = self.faces(foot);
        let is_own = |face: DVec3| (face - normal).length() < SAME && (p - foot).dot(face).abs() < SAME;
        let own = normals.iter().position(|face| is_own(*face))?;
        let beyond = normals[1 - own];
        Some(Cut { edge: self, distance, foot, outward: if convex { beyond } else { -beyond } })
    }
}

/// A cut of a disc, at the border of the half-space `outward · (x − foot) ≤ 0`.
struct Cut<'a> {
    edge: &'a Edge,
    distance: f64,
    foot: DVec3,
    outward: DVec3,
}

impl Cut<'_> {
    fn keeps(&self, p: DVec3) -> bool {
        self.outward.dot(p - self.foot) <= SAME
    }

    /// The direction in which the edge of `other` leaves a corner that it shares with this one.
    fn leaving(&self, other: &Self) -> Option<DVec3> {
        let (Edge::Straight { ends, .. }, Edge::Straight { ends: [from, to], .. }) = (self.edge, other.edge)
        else {
            return None;
        };
        let is_end = |p: &DVec3| ends.iter().any(|end| end.distance(*p) < SAME);
        if is_end(from) { Some(to - from) } else { is_end(to).then(|| from - to) }
    }

    fn line(&self, centre: DVec3, normal: DVec3) -> Option<ClipLine> {
        ClipLine::of_half_space(self.outward, self.outward.dot(self.foot - centre), normal.as_vec3())
    }
}

/// A disc to be clipped.
pub struct Disc {
    /// Point of the surface that was sampled.
    pub sampled_at: DVec3,
    /// Its centre, which may lie off the surface.
    pub centre: DVec3,
    /// Unit normal of the surface.
    pub normal: DVec3,
    /// Its radius; of an ellipse, the longer semi-axis.
    pub radius: f64,
}

/// Clips a disc by the edges of its face that it reaches, or by the nearest two. If they share a corner of the face,
/// the kept part is that of the face at this corner; otherwise both cut.
pub fn clip(edges: &[Edge], disc: &Disc) -> Option<Clip> {
    let mut cuts: Vec<Cut> =
        edges.iter().filter_map(|edge| edge.cut(disc.sampled_at, disc.normal, disc.radius)).collect();
    cuts.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    let (first, rest) = cuts.split_first()?;
    // An edge of another face in the same plane may be within reach; that face has its own discs.
    let second = rest.iter().find(|cut| first.leaving(cut).is_some() || cut.keeps(disc.sampled_at));
    let concave = second.is_some_and(|cut| first.leaving(cut).is_some_and(|d| first.outward.dot(d) > 0.0));
    let line = |cut: &Cut| cut.line(disc.centre, disc.normal);
    Clip::of_some([line(first), second.and_then(line)], concave)
}
