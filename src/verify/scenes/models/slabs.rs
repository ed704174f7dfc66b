//! Thin slabs close together, to test that surfaces behind do not shine through.

use super::{box_edges, faces, piece, tinted};
use crate::verify::scenes::edges::Edge;
use crate::verify::scenes::query::Query;
use crate::verify::scenes::surface::{Kind, Piece};
use glam::DVec3;

/// Colours of the slabs in turn, sRGB codes.
const COLOURS: [[u8; 3]; 4] = [[230, 60, 40], [40, 110, 220], [60, 160, 60], [230, 170, 30]];
/// Offset of each slab behind the one above, so that all are visible.
const STEP: f64 = 0.3;

/// Level square slabs, one above the other.
pub fn slabs(query: &Query) -> Vec<Piece> {
    let slab = |(i, [centre, half]): (u32, [DVec3; 2])| {
        let texture = tinted(query, COLOURS[i as usize % COLOURS.len()]);
        faces(centre, half).map(move |face| Piece { kind: Kind::Polygon, sheet: i, ..piece(face, texture) })
    };
    (0..).zip(boxes(query)).flat_map(slab).collect()
}

/// The edges of all slabs.
pub fn slabs_edges(query: &Query) -> Vec<Edge> {
    boxes(query).flat_map(|[centre, half]| box_edges(centre, half)).collect()
}

/// Centre and half extent of each slab.
fn boxes(query: &Query) -> impl Iterator<Item = [DVec3; 2]> {
    let (gap, thickness) = (query.number("gap"), query.number("thickness"));
    (0..query.whole("slabs") as u32).map(move |i| {
        let down = f64::from(i) * (gap + thickness);
        let centre = DVec3::new(STEP * f64::from(i), -down, STEP * f64::from(i));
        [centre, DVec3::new(1.0, 0.5 * thickness, 1.0)]
    })
}
