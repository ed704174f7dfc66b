//! A machined part: a block with a step, a slot and a bore.

use super::{piece, texture};
use crate::verify::scenes::edges::Edge;
use crate::verify::scenes::query::Query;
use crate::verify::scenes::shapes::{Cylinder, Face, Region};
use crate::verify::scenes::surface::{Kind, Piece};
use glam::{DVec2, DVec3};

/// Half the part's thickness, along z.
pub const DEPTH: f64 = 0.7;
/// Middle of the bore, x and y.
pub const BORE: DVec2 = DVec2::new(0.4, -0.2);
/// Radius of the bore.
pub const BORE_RADIUS: f64 = 0.25;
/// Half the side of the square around the bore on the front.
const SQUARE: f64 = 0.4;
/// The outline, counter-clockwise around +z; every side is parallel to x or y.
pub const PROFILE: [[f64; 2]; 10] = [
    [-1.0, -0.6],
    [1.0, -0.6],
    [1.0, 0.2],
    [0.3, 0.2],
    [0.3, 0.6],
    [-0.2, 0.6],
    [-0.2, 0.2],
    [-0.5, 0.2],
    [-0.5, 0.6],
    [-1.0, 0.6],
];
/// Rectangles that fill the outline without the bore's square: least and greatest x, then y.
const FRONT: [[f64; 4]; 4] =
    [[-1.0, 0.0, -0.6, 0.2], [0.8, 1.0, -0.6, 0.2], [-1.0, -0.5, 0.2, 0.6], [-0.2, 0.3, 0.2, 0.6]];

/// The part.
pub fn part(query: &Query) -> Vec<Piece> {
    let texture = texture(query);
    let faces = sides().into_iter().chain([1.0, -1.0].into_iter().flat_map(front));
    let bore = Cylinder { centre: BORE.extend(0.0), radius: BORE_RADIUS, half: DEPTH };
    let mut pieces: Vec<_> =
        faces.map(|face| Piece { kind: Kind::Polygon, ..piece(face, texture) }).collect();
    pieces.push(piece(bore, texture));
    pieces
}

/// Edges of the part: parallel to z at the outline's corners, around front and back, and around both ends of the bore.
pub fn part_edges(_: &Query) -> Vec<Edge> {
    let count = PROFILE.len();
    let corner = |i: usize| DVec2::from(PROFILE[i % count]);
    let along = |i: usize| (corner(i + 1) - corner(i)).normalize();
    // The outline is counter-clockwise.
    let normal = |i: usize| (-along(i).perp()).extend(0.0);
    let upright = |i: usize| Edge::Straight {
        ends: [1.0, -1.0].map(|sign| corner(i + 1).extend(sign * DEPTH)),
        normals: [normal(i), normal(i + 1)],
        convex: along(i).perp_dot(along(i + 1)) > 0.0,
    };
    let around = |sign: f64| {
        let front = sign * DVec3::Z;
        let side = move |i: usize| Edge::Straight {
            ends: [corner(i), corner(i + 1)].map(|end| end.extend(sign * DEPTH)),
            normals: [normal(i), front],
            convex: true,
        };
        let centre = BORE.extend(sign * DEPTH);
        let rim = Edge::Rim { centre, normal: front, radius: BORE_RADIUS, hole: true };
        (0..count).map(side).chain([rim])
    };
    (0..count).map(upright).chain(around(1.0)).chain(around(-1.0)).collect()
}

/// The faces parallel to z, one per side of the outline.
fn sides() -> Vec<Face> {
    let side = |i: usize| {
        let (a, b) = (DVec2::from(PROFILE[i]), DVec2::from(PROFILE[(i + 1) % PROFILE.len()]));
        let along = (b - a).normalize();
        Face {
            centre: (0.5 * (a + b)).extend(0.0),
            axes: [along.extend(0.0), DVec3::Z],
            region: Region::Rectangle([0.5 * (b - a).length(), DEPTH]),
        }
    };
    (0..PROFILE.len()).map(side).collect()
}

/// The face in direction +z or −z.
fn front(sign: f64) -> Vec<Face> {
    let at = |x: f64, y: f64| DVec3::new(x, y, sign * DEPTH);
    let axes = if sign > 0.0 { [DVec3::X, DVec3::Y] } else { [DVec3::Y, DVec3::X] };
    let rectangle = |[left, right, low, high]: [f64; 4]| {
        let half = [0.5 * (right - left), 0.5 * (high - low)];
        let half = if sign > 0.0 { half } else { [half[1], half[0]] };
        Face { centre: at(0.5 * (left + right), 0.5 * (low + high)), axes, region: Region::Rectangle(half) }
    };
    let collar = |quarter: usize| {
        let [a, b] = axes;
        Face {
            centre: at(BORE.x, BORE.y),
            axes: [[a, b], [b, -a], [-a, -b], [-b, a]][quarter],
            region: Region::Collar { half: SQUARE, hole: BORE_RADIUS },
        }
    };
    FRONT.into_iter().map(rectangle).chain((0..4).map(collar)).collect()
}
