//! A scene of points, lines and polygons.

use super::{capped, faces, piece, tinted};
use crate::verify::scenes::query::Query;
use crate::verify::scenes::shapes::{Curve, Face, Patch, Region, Ribbon, Torus};
use crate::verify::scenes::surface::{Kind, Piece};
use glam::DVec3;
use std::f64::consts::TAU;

/// A torus for points, a spring and a ribbon for lines, a floor and a box for polygons.
pub fn mixed(query: &Query) -> Vec<Piece> {
    let mut pieces = vec![Piece { kind: Kind::Polygon, ..piece(floor(), tinted(query, [120, 120, 130])) }];
    let block = faces(DVec3::new(-0.75, 0.3, -0.2), DVec3::new(0.25, 0.3, 0.25));
    let blue = tinted(query, [40, 110, 220]);
    // Faces of the box on the floor are invisible and would coincide with it.
    let block = block.filter(|face| face.centre.y > 0.0);
    pieces.extend(block.map(|face| Piece { kind: Kind::Polygon, sheet: 1, ..piece(face, blue) }));
    // 13 and 5 periods of the default texture around it.
    let around = |periods: f64| periods / (5.0 * TAU);
    let torus = Torus { centre: DVec3::new(0.1, 0.17, 0.45), major: around(13.0), minor: around(5.0) };
    pieces.push(Piece { sheet: 2, ..piece(torus, tinted(query, [230, 60, 40])) });
    let base = DVec3::new(0.75, 0.05, -0.5);
    let spring = Curve::Helix { base, radii: [0.25, 0.2], rise: 1.0, turns: 6.0 };
    let spring = capped(spring, [0.03, 0.03], [192, 12], tinted(query, [90, 160, 90]));
    pieces.extend(spring.into_iter().map(|piece| Piece { sheet: 3, ..piece }));
    let ends = [DVec3::new(-0.4, 0.85, -0.7), DVec3::new(0.1, 1.3, -0.7), DVec3::new(0.55, 0.75, -0.7)];
    let ribbon =
        Ribbon { curve: Curve::Bezier(ends), half: 0.09, ends: 1.0, twist: 9.0, reference: DVec3::Z };
    let ribbon = piece(Patch::new(ribbon, [64, 6]), tinted(query, [230, 170, 30]));
    pieces.push(Piece { kind: Kind::Ribbon, sheet: 4, ..ribbon });
    pieces
}

fn floor() -> Face {
    Face { centre: DVec3::ZERO, axes: [DVec3::Z, DVec3::X], region: Region::Rectangle([1.2, 1.2]) }
}
