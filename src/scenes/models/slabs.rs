//! Thin slabs close together: what is behind must not shine through.

use super::{faces, piece, tinted};
use crate::scenes::query::Query;
use crate::scenes::surface::{Kind, Piece};
use glam::DVec3;

/// Colours, one for each slab in turn, sRGB codes.
const COLOURS: [[u8; 3]; 4] = [[230, 60, 40], [40, 110, 220], [60, 160, 60], [230, 170, 30]];
/// By how much each slab stands back behind the one above, so that all are seen.
const STEP: f64 = 0.3;

/// Level square slabs, one above the other.
pub fn slabs(query: &Query) -> Vec<Piece> {
    let (gap, thickness) = (query.number("gap"), query.number("thickness"));
    let count = query.whole("slabs") as u32;
    let slab = |i: u32| {
        let down = f64::from(i) * (gap + thickness);
        let centre = DVec3::new(STEP * f64::from(i), -down, STEP * f64::from(i));
        let texture = tinted(query, COLOURS[i as usize % COLOURS.len()]);
        faces(centre, DVec3::new(1.0, 0.5 * thickness, 1.0)).map(move |face| Piece {
            kind: Kind::Polygon,
            sheet: i,
            ..piece(face, texture)
        })
    };
    (0..count).flat_map(slab).collect()
}
