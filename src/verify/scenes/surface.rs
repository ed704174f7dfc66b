//! Surfaces: pieces of shapes with albedos, which are sampled and traced by the same definition.

use super::hierarchy::{Hierarchy, union};
use super::shapes::{Ray, Shape};
use super::texture::Texture;
use crate::geometry::Bounds;
use glam::DVec3;

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction.
    pub t: f64,
    /// The point.
    pub position: DVec3,
    /// Unit normal of the outer side.
    pub normal: DVec3,
    /// Albedo, linear RGB.
    pub albedo: [f64; 3],
}

/// A surface that is known exactly.
pub trait Surface: Send + Sync {
    /// A box and a sphere that hold it.
    fn bounds(&self) -> Bounds;

    /// The nearest point that a ray meets at `t > 0`. `direction` may have any length; a zero or non-finite ray meets nothing.
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit>;

    /// Area of all pieces, hidden parts included.
    fn area(&self) -> f64;

    /// What it is made of.
    fn pieces(&self) -> &[Piece];
}

/// As what a piece may be drawn. Samplers make surfels of all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// By surfels.
    Surface,
    /// By a line with a tube's shading.
    Tube,
    /// By a line with a width, seen from both sides.
    Ribbon,
    /// By polygons.
    Polygon,
}

/// A shape with an albedo.
pub struct Piece {
    /// The shape.
    pub shape: Box<dyn Shape>,
    /// Its albedo.
    pub texture: Texture,
    /// As what it may be drawn.
    pub kind: Kind,
    /// As polygons, the radius of its vertices at u = 1, where it meets what is made of points.
    pub seam: f64,
    /// Pieces with the same number meet at their edges; samplers keep their points apart from each other.
    pub sheet: u32,
}

impl Piece {
    /// Whether it is an open sheet, of which either side is seen.
    pub fn is_two_sided(&self) -> bool {
        self.kind == Kind::Ribbon
    }
}

/// A surface made of pieces.
pub struct Assembly {
    pieces: Vec<Piece>,
    hierarchy: Hierarchy,
    bounds: Bounds,
}

impl Assembly {
    /// The union of `pieces`.
    pub fn new(pieces: Vec<Piece>) -> Self {
        let boxes: Vec<_> = pieces.iter().map(|piece| piece.shape.corners()).collect();
        let [min, max] = boxes.iter().copied().reduce(union).unwrap_or_default();
        Self { pieces, hierarchy: Hierarchy::new(&boxes), bounds: Bounds::of_box(min, max) }
    }
}

impl Surface for Assembly {
    fn bounds(&self) -> Bounds {
        self.bounds
    }

    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let length = direction.length();
        let direction = direction.try_normalize().filter(|_| origin.is_finite() && length.is_finite())?;
        // From a point near the surface, so that far origins cost no digits there.
        let skipped = ((self.bounds.centre() - origin).dot(direction) - 1.001 * self.bounds.radius).max(0.0);
        let ray = Ray { origin: origin + skipped * direction, direction };
        let mut found = None;
        self.hierarchy.visit(&ray, f64::INFINITY, |index, limit| {
            let piece = &self.pieces[index as usize];
            match piece.shape.trace(&ray, limit) {
                Some((t, spot)) => {
                    found = Some((t, spot, piece));
                    t
                }
                None => limit,
            }
        });
        let (t, spot, piece) = found?;
        let albedo = piece.texture.at(&spot);
        Some(Hit { t: (t + skipped) / length, position: spot.position, normal: spot.normal, albedo })
    }

    fn area(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.shape.area()).sum()
    }

    fn pieces(&self) -> &[Piece] {
        &self.pieces
    }
}
