//! Axis-aligned bounds.

use glam::{DVec3, Vec3};

/// The axis-aligned box of a set of points, in the points' own unit and frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub min: DVec3,
    /// Greatest coordinates.
    pub max: DVec3,
}

impl Bounds {
    /// The bounds of `points`; `None` if there are none.
    pub fn of(points: &[Vec3]) -> Option<Self> {
        let first = *points.first()?;
        let (min, max) = points.iter().fold((first, first), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        Some(Self { min: min.as_dvec3(), max: max.as_dvec3() })
    }

    /// The middle of the box.
    pub fn centre(&self) -> DVec3 {
        // Halved before the sum, so that the largest finite coordinates do not overflow.
        0.5 * self.min + 0.5 * self.max
    }

    /// Radius of the sphere about [`Bounds::centre`] through the corners.
    pub fn radius(&self) -> f64 {
        (0.5 * self.max - 0.5 * self.min).length()
    }

    /// The same box moved by `offset`.
    pub fn translated(&self, offset: DVec3) -> Self {
        Self { min: self.min + offset, max: self.max + offset }
    }

    /// The same box with every face moved outwards by `margin`.
    pub fn grown(&self, margin: f64) -> Self {
        Self { min: self.min - margin, max: self.max + margin }
    }
}
