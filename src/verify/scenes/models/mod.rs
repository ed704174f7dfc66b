//! Pieces of each scene.

mod mixed;
pub mod part;
mod slabs;
mod tree;

pub use mixed::mixed;
pub use part::{part, part_edges};
pub use slabs::{slabs, slabs_edges};
pub use tree::tree;

use super::edges::Edge;
use super::query::Query;
use super::shapes::{
    Bumpy, Curve, Face, Ground, Patch, Region, Relief, Ribbon, Shape, Span, Sphere, Torus, Tube,
};
use super::surface::{Kind, Piece};
use super::texture::Texture;
use glam::DVec3;
use std::f64::consts::TAU;

/// A sphere.
pub fn sphere(query: &Query) -> Vec<Piece> {
    one(Sphere { centre: DVec3::ZERO, radius: 1.0 }, query)
}

/// A sphere with bumps.
pub fn bumpy_sphere(query: &Query) -> Vec<Piece> {
    one(Bumpy, query)
}

/// A flat disc, black and white.
pub fn disc(query: &Query) -> Vec<Piece> {
    let face = Face { centre: DVec3::ZERO, axes: [DVec3::Z, DVec3::X], region: Region::Disc(1.0) };
    vec![piece(face, Texture { colours: [[0.0; 3], [1.0; 3]], ..texture(query) })]
}

/// The rim of the disc.
pub fn disc_edges(_: &Query) -> Vec<Edge> {
    vec![Edge::Rim { centre: DVec3::ZERO, normal: DVec3::Y, radius: 1.0, hole: false }]
}

/// A torus.
pub fn torus(query: &Query) -> Vec<Piece> {
    one(Torus { centre: DVec3::ZERO, major: 1.0, minor: query.number("minor") }, query)
}

/// A plane to the horizon.
pub fn plane(query: &Query) -> Vec<Piece> {
    one(Ground { radius: query.number("radius"), height: 1.0 }, query)
}

/// A relief that fills the picture.
pub fn relief(query: &Query) -> Vec<Piece> {
    one(Patch::new(Relief { half: 6.0, height: query.number("height") }, [96, 96]), query)
}

/// A twisted ribbon.
pub fn ribbon(query: &Query) -> Vec<Piece> {
    let curve = Curve::Bezier([DVec3::new(-1.5, 0.0, 0.0), DVec3::ZERO, DVec3::new(1.5, 0.0, 0.0)]);
    let twist = TAU * query.number("twists");
    let ribbon = Ribbon { curve, half: query.number("width") / 2.0, ends: 1.0, twist, reference: DVec3::Y };
    // A cell turns by a few degrees.
    let cells = 32 + (48.0 * query.number("twists")) as usize;
    vec![Piece { kind: Kind::Ribbon, ..piece(Patch::new(ribbon, [cells, 8]), texture(query)) }]
}

/// A tapered tube along a helix.
pub fn helix(query: &Query) -> Vec<Piece> {
    let turns = query.number("turns");
    let curve = Curve::Helix { base: DVec3::new(0.0, -1.0, 0.0), radii: [0.8, 0.3], rise: 2.0, turns };
    capped(curve, [0.6 / turns, 0.18 / turns], [(32.0 * turns) as usize + 8, 16], texture(query))
}

/// A horn of two pieces, one for polygons and one for points.
pub fn hybrid(query: &Query) -> Vec<Piece> {
    let ends = [DVec3::new(-0.5, -1.0, 0.0), DVec3::new(0.9, -0.2, 0.0), DVec3::new(0.1, 1.0, 0.0)];
    let horn = Tube { curve: Curve::Bezier(ends), radii: [0.55, 0.15], reference: DVec3::Z };
    let half = |from: f64| Patch::new(Span { surface: horn, from, length: 0.5 }, [16, 24]);
    let lower = Piece { kind: Kind::Polygon, seam: query.number("seam"), ..piece(half(0.0), texture(query)) };
    vec![lower, piece(half(0.5), texture(query))]
}

/// A tube around a curve, with flat ends.
fn capped(curve: Curve, radii: [f64; 2], cells: [usize; 2], texture: Texture) -> Vec<Piece> {
    let cap = |s: f64, radius: f64| {
        let frame = curve.frame(s, DVec3::Y);
        let [a, b] = [frame.normal[0], frame.binormal[0]];
        // a × b is along the tangent.
        let axes = if s > 0.5 { [a, b] } else { [b, a] };
        Face { centre: frame.point[0], axes, region: Region::Disc(radius) }
    };
    let tube = Patch::new(Tube { curve, radii, reference: DVec3::Y }, cells);
    let mut pieces =
        vec![piece(tube, texture), piece(cap(0.0, radii[0]), texture), piece(cap(1.0, radii[1]), texture)];
    pieces.iter_mut().for_each(|piece| piece.kind = Kind::Tube);
    pieces
}

/// The six faces of a box, facing outwards.
fn faces(centre: DVec3, half: DVec3) -> impl Iterator<Item = Face> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    (0..6usize).map(move |i| {
        let (axis, sign) = (i % 3, if i < 3 { 1.0 } else { -1.0 });
        let (a, b) = ((axis + 1) % 3, (axis + 2) % 3);
        let sides = if sign > 0.0 { [a, b] } else { [b, a] };
        Face {
            centre: centre + sign * half[axis] * axes[axis],
            axes: sides.map(|side| axes[side]),
            region: Region::Rectangle(sides.map(|side| half[side])),
        }
    })
}

/// The twelve edges of a box.
fn box_edges(centre: DVec3, half: DVec3) -> impl Iterator<Item = Edge> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z];
    (0..12usize).map(move |i| {
        let [along, a, b] = [0, 1, 2].map(|turn| (i + turn) % 3);
        let [a, b] = [(a, i / 3 % 2), (b, i / 6)].map(|(axis, side)| [1.0, -1.0][side] * axes[axis]);
        let middle = centre + half * (a + b);
        let reach = half * axes[along];
        Edge::Straight { ends: [middle - reach, middle + reach], normals: [a, b], convex: true }
    })
}

fn one(shape: impl Shape + 'static, query: &Query) -> Vec<Piece> {
    vec![piece(shape, texture(query))]
}

fn piece(shape: impl Shape + 'static, texture: Texture) -> Piece {
    Piece { shape: Box::new(shape), texture, kind: Kind::Surface, seam: 0.0, sheet: 0 }
}

/// The texture of the query, red and cream.
fn texture(query: &Query) -> Texture {
    tinted(query, [230, 60, 40])
}

/// The texture of the query, with another colour, in sRGB codes, for red.
fn tinted(query: &Query, code: [u8; 3]) -> Texture {
    use super::texture::linear;
    Texture {
        pattern: query.pattern(),
        frequency: query.number("frequency"),
        colours: [linear(code), linear([240, 235, 220])],
    }
}
