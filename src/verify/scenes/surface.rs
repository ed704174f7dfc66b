//! Surfaces: pieces of shapes with albedos, sampled and traced by one definition.

use super::shapes::{Ray, Shape};
use super::texture::Texture;
use crate::geometry::Bounds;
use crate::verify::hierarchy::{Hierarchy, union};
use glam::DVec3;

/// Intersection of a ray with a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance, in lengths of the ray's direction.
    pub t: f64,
    /// The point.
    pub position: DVec3,
    /// Unit normal of the outer side.
    pub normal: DVec3,
    /// Albedo, linear RGB.
    pub albedo: [f64; 3],
}

/// A surface with exact ray intersections.
pub trait Surface: Send + Sync {
    /// Bounding box and sphere.
    fn bounds(&self) -> Bounds;

    /// The nearest intersection with a ray at `t > 0`. `direction` may have any length; a zero or non-finite ray has
    /// none.
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit>;

    /// Area of all pieces, hidden parts included.
    fn area(&self) -> f64;

    /// Its pieces.
    fn pieces(&self) -> &[Piece];
}

/// Primitive that a piece may be drawn as. Samplers produce surfels for all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Surfels.
    Surface,
    /// A line, shaded as a tube.
    Tube,
    /// A line with a width, visible from both sides.
    Ribbon,
    /// Polygons.
    Polygon,
}

/// A shape with an albedo.
pub struct Piece {
    /// The shape.
    pub shape: Box<dyn Shape>,
    /// Its albedo.
    pub texture: Texture,
    /// Primitive that it may be drawn as.
    pub kind: Kind,
    /// Radius of its polygons' vertices at u = 1, where they meet points.
    pub seam: f64,
    /// Pieces with the same number meet at their edges; samplers keep a minimum distance between their points.
    pub sheet: u32,
}

impl Piece {
    /// Whether it is an open sheet, visible from both sides.
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
        // Starts near the surface, so that far origins lose no digits.
        let skipped = ((self.bounds.centre() - origin).dot(direction) - 1.001 * self.bounds.radius).max(0.0);
        let ray = Ray { origin: origin + skipped * direction, direction };
        let mut found = None;
        self.hierarchy.visit([ray.origin, ray.direction], f64::INFINITY, |index, limit| {
            let piece = &self.pieces[index as usize];
            match piece.shape.trace(&ray, limit) {
                Some((t, point)) => {
                    found = Some((t, point, piece));
                    t
                }
                None => limit,
            }
        });
        let (t, point, piece) = found?;
        let albedo = piece.texture.at(&point);
        Some(Hit { t: (t + skipped) / length, position: point.position, normal: point.normal, albedo })
    }

    fn area(&self) -> f64 {
        self.pieces.iter().map(|piece| piece.shape.area()).sum()
    }

    fn pieces(&self) -> &[Piece] {
        &self.pieces
    }
}
