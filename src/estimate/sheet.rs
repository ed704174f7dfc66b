//! A part of a surface that hangs together: what tells its inside from its outside.

use glam::{DVec3, Vec3};

/// Sums over the discs of a sheet whose normals agree.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sheet {
    discs: u64,
    area: f64,
    /// Sum of normals times areas: 0 of a closed surface.
    vector: DVec3,
    /// Sum of positions times areas.
    moment: DVec3,
    /// Sum of squared distances from 0 times areas.
    second_moment: f64,
    /// Sum of normal · position times area: three times the volume of a closed surface, negative if the normals point inwards.
    flux: f64,
    /// Pairs of neighbours whose normals are surely parallel or antiparallel.
    pub sure: u64,
    /// Those of them that contradict the others.
    pub contradicted: u64,
}

/// A surface whose vector area is below this part of its area is closed. A half sphere's is 0.5.
const CLOSED: f64 = 0.15;
/// And whose volume is at least this part of that of a sphere with the same area and extent: not crumpled.
const FULL: f64 = 0.15;
/// And that contradicts itself in at most this part of its sure pairs, where noise or clutter has no side at all.
const CONTRADICTED: f64 = 0.01;
/// And that has at least as many discs.
const LEAST_DISCS: u64 = 32;

impl Sheet {
    pub fn add(&mut self, normal: Vec3, position: Vec3, area: f32) {
        let (normal, position, area) = (normal.as_dvec3(), position.as_dvec3(), f64::from(area));
        self.discs += 1;
        self.area += area;
        self.vector += area * normal;
        self.moment += area * position;
        self.second_moment += area * position.length_squared();
        self.flux += area * normal.dot(position);
    }

    /// Whether it has an outside, without doubt.
    pub fn is_closed(&self) -> bool {
        let middle = self.moment / self.area;
        let extent = (self.second_moment / self.area - middle.length_squared()).max(0.0).sqrt();
        self.discs >= LEAST_DISCS
            && self.vector.length() < CLOSED * self.area
            && self.volume().abs() >= FULL * self.area * extent
            && self.contradicted as f64 <= CONTRADICTED * self.sure as f64
    }

    /// Three times the volume, seen from the middle; negative if the normals point inwards.
    pub fn volume(&self) -> f64 {
        self.flux - self.vector.dot(self.moment / self.area)
    }
}
