//! Shapes: parametrized for sampling, with ray intersections; one definition serves both.

mod bumpy;
mod curve;
mod cylinder;
mod face;
mod ground;
mod patch;
mod polynomial;
mod relief;
mod ribbon;
mod span;
mod sphere;
mod torus;
mod tube;

pub use bumpy::Bumpy;
pub use curve::Curve;
pub use cylinder::Cylinder;
pub use face::{Face, Region};
pub use ground::Ground;
pub use patch::Patch;
#[cfg(test)]
pub use patch::{Jet, Parametric};
pub use relief::Relief;
pub use ribbon::Ribbon;
pub use span::Span;
pub use sphere::Sphere;
pub use torus::Torus;
pub use tube::Tube;

use super::primitives::CentrelinePoint;
use glam::{DVec2, DVec3};

/// Relative distance beyond its border at which a trimmed shape is still hit: shapes that share an edge leave no gap.
const EDGE: f64 = 1e-12;

/// A ray whose origin is near the shapes.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    /// Start.
    pub origin: DVec3,
    /// Unit vector.
    pub direction: DVec3,
}

impl Ray {
    /// The point at distance `t`.
    pub fn at(&self, t: f64) -> DVec3 {
        self.origin + t * self.direction
    }

    /// The ray's parameter nearest to `centre`, and the point there relative to `centre`.
    fn foot(&self, centre: DVec3) -> (f64, DVec3) {
        let t = (centre - self.origin).dot(self.direction);
        (t, self.at(t) - centre)
    }
}

/// A point of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// Where it is.
    pub position: DVec3,
    /// Unit normal of the outer side.
    pub normal: DVec3,
    /// Texture coordinates, in lengths as far as the shape can be unrolled.
    pub chart: DVec2,
}

/// A point of a shape, with derivatives by its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// The point.
    pub point: SurfacePoint,
    /// |∂P/∂u × ∂P/∂v|.
    pub element: f64,
    /// |∂P/∂v|.
    pub along_v: f64,
}

/// A surface with parameters (u, v) in the unit square.
pub trait Shape: Send + Sync {
    /// The point at (u, v).
    fn at(&self, uv: DVec2) -> Sample;

    /// The nearest intersection with a ray at a distance above 0 and below `limit`.
    fn trace(&self, ray: &Ray, limit: f64) -> Option<(f64, SurfacePoint)>;

    /// Bounding box.
    fn corners(&self) -> [DVec3; 2];

    /// Numbers of cells along u and v for the samplers, such that the area element varies little in each cell.
    fn cells(&self) -> [usize; 2] {
        [32, 32]
    }

    /// Area: by default the integral of the element over the cells, by Gauss's rule of three points.
    fn area(&self) -> f64 {
        let size = self.cells();
        let cells = (0..size[0] * size[1]).map(|i| [i % size[0], i / size[0]]);
        cells.map(|cell| integrate(cell, size, |uv| self.at(uv).element)).sum()
    }

    /// The point of its centre line at the parameter u, if it has one.
    fn centreline(&self, _: f64) -> Option<CentrelinePoint> {
        None
    }

    /// Position in sampling space, in which samples are uniform, and the ratio of a length at `position` to its length
    /// there. By default the identity.
    fn to_sampling_space(&self, position: DVec3) -> (DVec3, f64) {
        (position, 1.0)
    }
}

/// The integral of `f` over a cell of the unit square, by Gauss's rule of three points.
pub fn integrate(cell: [usize; 2], size: [usize; 2], f: impl Fn(DVec2) -> f64) -> f64 {
    let node = 0.5 * 0.6f64.sqrt();
    let nodes = [(0.5 - node, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + node, 5.0 / 18.0)];
    let size = DVec2::new(size[0] as f64, size[1] as f64);
    let corner = DVec2::new(cell[0] as f64, cell[1] as f64);
    let rows = nodes.iter().flat_map(|v| nodes.iter().map(move |u| (DVec2::new(u.0, v.0), u.1 * v.1)));
    rows.map(|(at, weight)| weight * f((corner + at) / size)).sum::<f64>() / (size.x * size.y)
}

/// The first of two distances, in ascending order, that lies above 0 and below `limit` and is accepted.
fn first<T>(pair: [f64; 2], limit: f64, accept: impl Fn(f64) -> Option<T>) -> Option<(f64, T)> {
    let inside = pair.into_iter().filter(|t| *t > 0.0 && *t < limit);
    inside.filter_map(|t| Some((t, accept(t)?))).next()
}
