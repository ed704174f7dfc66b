//! Ray intersections with smooth parametrized surfaces: no crossing is missed where the bounds of the second
//! derivatives hold.
//!
//! The surface is divided into cells in (u, v). In a cell with half sides h, Taylor's formula with a bound of the
//! second derivatives encloses the surface, seen along the ray, in the image of the tangent plane widened by a
//! remainder. A part that the ray cannot reach is dropped, and so is one whose linearized root lies outside of it by
//! more than the remainder. If the derivative, preconditioned by its inverse in the centre, varies by less than 1,
//! there is at most one root (Krawczyk), which Newton's method finds. Any other part is divided, down to [`FINEST`] of
//! a cell. A part that is still undecided touches the ray to within about `FINEST`² of the cell's size and counts as a
//! hit.
//!
//! The bounds of the second derivatives are finite differences at nine points of each cell, times 1.5: cells must be
//! small relative to the surface's features.

use super::{Ray, Sample, Shape, SurfacePoint};
use crate::verify::hierarchy::{Hierarchy, union};
use crate::verify::scenes::CentrelinePoint;
use glam::{DMat2, DVec2, DVec3};
use rayon::prelude::*;

/// Smallest part of a cell, relative to the cell's side.
const FINEST: f64 = 1e-6;
/// Cells for rays per cell for the samplers, in either direction: in such small cells most crossings are known at once
/// to be the only ones, and cells need not be divided.
const FINER: usize = 2;
/// Relative distance beyond its border within which a part's roots count.
const TOLERANCE: f64 = 1e-9;
/// Factor of the bounds from finite differences.
const SAFETY: f64 = 1.5;

/// A point of a parametrised surface with its derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Jet {
    /// The point.
    pub position: DVec3,
    /// ∂P/∂u.
    pub du: DVec3,
    /// ∂P/∂v.
    pub dv: DVec3,
}

/// A smooth surface over the unit square. Its outer side is that of `du × dv`.
pub trait Parametric: Send + Sync {
    /// The point and its derivatives; u and v may lie slightly outside of the unit square.
    fn jet(&self, uv: DVec2) -> Jet;

    /// Mean lengths along u and v, which scale (u, v) to texture coordinates.
    fn extent(&self) -> DVec2;

    /// The point of its centre line, if it has one.
    fn centreline(&self, _: f64) -> Option<CentrelinePoint> {
        None
    }
}

/// A parametrised surface, divided into cells.
pub struct Patch<P> {
    surface: P,
    /// Numbers of cells along u and v for the samplers.
    size: [usize; 2],
    extent: DVec2,
    /// Row by row of v, [`FINER`] times as many in either direction.
    cells: Vec<Cell>,
    hierarchy: Hierarchy,
    corners: [DVec3; 2],
}

/// A part of the (u, v) square: its centre and half its sides.
#[derive(Clone, Copy)]
struct Part {
    middle: DVec2,
    half: DVec2,
}

struct Cell {
    part: Part,
    curvature: CurvatureBounds,
    /// The jet in the part's centre, shared by all rays.
    jet: Jet,
}

/// An intersection: distance, parameters and the point.
type Intersection = (f64, DVec2, Jet);

/// Bounds of |∂²P/∂u²|, |∂²P/∂u∂v| and |∂²P/∂v²|.
#[derive(Clone, Copy)]
struct CurvatureBounds {
    uu: f64,
    uv: f64,
    vv: f64,
}

/// A ray as two planes and a direction: a point is on it if both distances are 0.
struct RayPlanes {
    ray: Ray,
    planes: [DVec3; 2],
}

enum PartClass {
    Nothing,
    Root(DVec2),
    Unknown,
}

impl<P: Parametric> Patch<P> {
    /// Divides `surface` into this many cells of u and v.
    pub fn new(surface: P, size: [usize; 2]) -> Self {
        let [columns, rows] = size.map(|cells| FINER * cells);
        let half = 0.5 / DVec2::new(columns as f64, rows as f64);
        let cell = |i: usize| {
            let index = DVec2::new((i % columns) as f64, (i / columns) as f64);
            let part = Part { middle: (2.0 * index + 1.0) * half, half };
            let curvature = CurvatureBounds::of(&surface, part);
            let jet = surface.jet(part.middle);
            let reach = jet.du.abs() * half.x + jet.dv.abs() * half.y + curvature.remainder(half);
            (Cell { part, curvature, jet }, [jet.position - reach, jet.position + reach])
        };
        let (cells, boxes): (Vec<_>, Vec<_>) = (0..columns * rows).into_par_iter().map(cell).unzip();
        let corners = boxes.iter().copied().reduce(union).unwrap_or_default();
        let extent = surface.extent();
        Self { size, extent, cells, hierarchy: Hierarchy::new(&boxes), corners, surface }
    }

    fn point(&self, uv: DVec2, jet: &Jet) -> SurfacePoint {
        let normal = jet.du.cross(jet.dv).normalize_or(DVec3::Y);
        SurfacePoint { position: jet.position, normal, chart: uv * self.extent }
    }

    /// The intersection nearest to the ray's origin, at less than `limit`, inside the cell.
    fn meet(&self, planes: &RayPlanes, cell: &Cell, limit: f64) -> Option<Intersection> {
        match self.classify(planes, cell.part, &cell.jet, &cell.curvature, limit) {
            PartClass::Nothing => None,
            PartClass::Root(uv) => self.take(planes, uv, limit),
            PartClass::Unknown => self.search(planes, cell, limit),
        }
    }

    /// The same for a cell that must be divided.
    fn search(&self, planes: &RayPlanes, cell: &Cell, mut limit: f64) -> Option<Intersection> {
        let mut found = None;
        let mut todo = Vec::from(cell.part.quarters());
        while let Some(part) = todo.pop() {
            let hit =
                match self.classify(planes, part, &self.surface.jet(part.middle), &cell.curvature, limit) {
                    PartClass::Nothing => None,
                    PartClass::Root(uv) => self.take(planes, uv, limit),
                    PartClass::Unknown if part.half.x > FINEST * cell.part.half.x => {
                        todo.extend(part.quarters());
                        None
                    }
                    PartClass::Unknown => self.take(planes, part.middle, limit),
                };
            if let Some(hit) = hit {
                limit = hit.0;
                found = Some(hit);
            }
        }
        found
    }

    fn take(&self, planes: &RayPlanes, uv: DVec2, limit: f64) -> Option<Intersection> {
        let jet = self.surface.jet(uv);
        let t = planes.distance(jet.position);
        (t > 0.0 && t < limit).then_some((t, uv, jet))
    }

    fn classify(
        &self,
        planes: &RayPlanes,
        part: Part,
        jet: &Jet,
        curvature: &CurvatureBounds,
        limit: f64,
    ) -> PartClass {
        let (remainder, half) = (curvature.remainder(part.half), part.half);
        let (offset, slopes) = (planes.offset(jet.position), planes.slopes(jet));
        let reach = slopes.x_axis.abs() * half.x + slopes.y_axis.abs() * half.y + remainder;
        let depth = planes.distance(jet.position);
        let d = planes.ray.direction;
        let deep = jet.du.dot(d).abs() * half.x + jet.dv.dot(d).abs() * half.y + remainder;
        if offset.abs().cmpgt(reach).any() || depth + deep <= 0.0 || depth - deep >= limit {
            return PartClass::Nothing;
        }
        let inverse = slopes.inverse();
        if !inverse.is_finite() {
            return PartClass::Unknown;
        }
        // Norms of the inverse's rows: the greatest change of u and v per length across the ray.
        let gain = DVec2::new(inverse.row(0).length(), inverse.row(1).length());
        let step = -(inverse * offset);
        if step.abs().cmpgt(half * (1.0 + TOLERANCE) + gain * remainder).any() {
            return PartClass::Nothing;
        }
        let vary = (curvature.uu * half.x + curvature.uv * half.y) * half.x
            + (curvature.uv * half.x + curvature.vv * half.y) * half.y;
        if (gain * vary / half).max_element() >= 1.0 {
            return PartClass::Unknown;
        }
        self.newton(planes, part, part.middle + step.clamp(-half, half))
    }

    /// The only possible root of the part.
    fn newton(&self, planes: &RayPlanes, part: Part, start: DVec2) -> PartClass {
        let mut uv = start;
        for _ in 0..12 {
            let jet = self.surface.jet(uv);
            let step = planes.slopes(&jet).inverse() * planes.offset(jet.position);
            if !((uv - step - part.middle).abs().cmple(4.0 * part.half).all()) {
                return PartClass::Unknown;
            }
            uv -= step;
            // Steps square their error: the next one would be below rounding.
            if step.abs().cmple(1e-6 * part.half).all() {
                let inside = (uv - part.middle).abs().cmple(part.half * (1.0 + TOLERANCE)).all();
                return if inside { PartClass::Root(uv) } else { PartClass::Nothing };
            }
        }
        PartClass::Unknown
    }
}

impl<P: Parametric> Shape for Patch<P> {
    fn at(&self, uv: DVec2) -> Sample {
        let jet = self.surface.jet(uv);
        Sample {
            point: self.point(uv, &jet),
            element: jet.du.cross(jet.dv).length(),
            along_v: jet.dv.length(),
        }
    }

    fn trace(&self, ray: &Ray, limit: f64) -> Option<(f64, SurfacePoint)> {
        let planes = RayPlanes::new(*ray);
        let mut found = None;
        self.hierarchy.visit([ray.origin, ray.direction], limit, |cell, limit| {
            match self.meet(&planes, &self.cells[cell as usize], limit) {
                Some(hit) => {
                    found = Some(hit);
                    hit.0
                }
                None => limit,
            }
        });
        found.map(|(t, uv, jet)| (t, self.point(uv, &jet)))
    }

    fn corners(&self) -> [DVec3; 2] {
        self.corners
    }

    fn cells(&self) -> [usize; 2] {
        self.size
    }

    fn centreline(&self, u: f64) -> Option<CentrelinePoint> {
        self.surface.centreline(u)
    }
}

impl Part {
    fn quarters(self) -> [Self; 4] {
        let half = 0.5 * self.half;
        [DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0), DVec2::new(-1.0, 1.0), DVec2::ONE]
            .map(|side| Self { middle: self.middle + side * half, half })
    }
}

impl CurvatureBounds {
    fn of<P: Parametric>(surface: &P, part: Part) -> Self {
        let mut most = Self { uu: 0.0, uv: 0.0, vv: 0.0 };
        let (du, dv) = (DVec2::new(0.25 * part.half.x, 0.0), DVec2::new(0.0, 0.25 * part.half.y));
        for i in 0..9u32 {
            let node = DVec2::new(f64::from(i % 3) - 1.0, f64::from(i / 3) - 1.0);
            let at = part.middle + node * part.half;
            let [right, left, up, down] = [at + du, at - du, at + dv, at - dv].map(|uv| surface.jet(uv));
            most.uu = most.uu.max((right.du - left.du).length() / (2.0 * du.x));
            most.uv = most.uv.max((up.du - down.du).length() / (2.0 * dv.y));
            most.vv = most.vv.max((up.dv - down.dv).length() / (2.0 * dv.y));
        }
        // Zero curvature, as of a ruling, has rounding errors.
        Self { uu: SAFETY * most.uu + 1e-9, uv: SAFETY * most.uv + 1e-9, vv: SAFETY * most.vv + 1e-9 }
    }

    /// Bound of the distance from the tangent plane's point with the same parameters.
    fn remainder(&self, half: DVec2) -> f64 {
        0.5 * (self.uu * half.x * half.x + 2.0 * self.uv * half.x * half.y + self.vv * half.y * half.y)
    }
}

impl RayPlanes {
    fn new(ray: Ray) -> Self {
        let side = ray.direction.any_orthonormal_vector();
        Self { ray, planes: [side, ray.direction.cross(side)] }
    }

    fn offset(&self, position: DVec3) -> DVec2 {
        let from = position - self.ray.origin;
        DVec2::new(from.dot(self.planes[0]), from.dot(self.planes[1]))
    }

    /// Derivatives of the offset by u and v, as columns.
    fn slopes(&self, jet: &Jet) -> DMat2 {
        let column = |d: DVec3| DVec2::new(d.dot(self.planes[0]), d.dot(self.planes[1]));
        DMat2::from_cols(column(jet.du), column(jet.dv))
    }

    fn distance(&self, position: DVec3) -> f64 {
        (position - self.ray.origin).dot(self.ray.direction)
    }
}
