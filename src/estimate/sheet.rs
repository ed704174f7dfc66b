//! A connected part of a surface: sums that tell its inside from its outside.

use glam::DVec3;

/// Sums over the discs of a sheet with consistent normals.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sheet {
    discs: u64,
    area: f64,
    /// Sum of normal × area: 0 for a closed surface.
    vector: DVec3,
    /// Sum of position × area.
    moment: DVec3,
    /// Sum of squared distance from 0 × area.
    second_moment: f64,
    /// Sum of (normal · position) × area: three times the volume of a closed surface, negative if the normals point inwards.
    flux: f64,
    /// Number of neighbour pairs with reliably parallel or antiparallel normals.
    pub sure: u64,
    /// Number of these pairs that contradict the others.
    pub contradicted: u64,
}

/// A surface is closed if its vector area is below this part of its area (a half sphere has 0.5).
const CLOSED: f64 = 0.15;
/// Its volume is at least this part of that of a sphere with the same area and extent, so that it is not crumpled.
const FULL: f64 = 0.15;
/// At most this part of its reliable pairs contradict, so that it is not noise or clutter.
const CONTRADICTED: f64 = 0.01;
/// It has at least this number of discs.
const LEAST_DISCS: u64 = 32;

impl Sheet {
    pub fn add(&mut self, normal: DVec3, position: DVec3, area: f64) {
        self.discs += 1;
        self.area += area;
        self.vector += area * normal;
        self.moment += area * position;
        self.second_moment += area * position.length_squared();
        self.flux += area * normal.dot(position);
    }

    /// Whether neighbours agree well enough that it is reliably closed.
    pub fn is_closed(&self) -> bool {
        self.discs >= LEAST_DISCS
            && self.encloses()
            && self.contradicted as f64 <= CONTRADICTED * self.sure as f64
    }

    /// Whether it has an outside, as far as its normals are consistent.
    pub fn encloses(&self) -> bool {
        let middle = self.moment / self.area;
        let extent = (self.second_moment / self.area - middle.length_squared()).max(0.0).sqrt();
        self.vector.length() < CLOSED * self.area && self.volume().abs() >= FULL * self.area * extent
    }

    /// Three times the volume about the centre; negative if the normals point inwards.
    pub fn volume(&self) -> f64 {
        self.flux - self.vector.dot(self.moment / self.area)
    }
}
