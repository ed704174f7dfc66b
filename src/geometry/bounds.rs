//! Bounds: an axis-aligned box and a sphere.

use glam::{DVec3, Vec3};

/// Axis-aligned box and bounding sphere of points, in the points' unit and frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// Least coordinates.
    pub min: DVec3,
    /// Greatest coordinates.
    pub max: DVec3,
    /// Radius of the bounding sphere around [`Bounds::centre`].
    pub radius: f64,
}

impl Bounds {
    /// The bounds of `points`; `None` if there are none.
    pub fn of(points: &[Vec3]) -> Option<Self> {
        let first = *points.first()?;
        let (min, max) = points.iter().fold((first, first), |(lo, hi), p| (lo.min(*p), hi.max(*p)));
        let (min, max) = (min.as_dvec3(), max.as_dvec3());
        let centre = Self::of_box(min, max).centre();
        let square = points.iter().map(|p| p.as_dvec3().distance_squared(centre)).fold(0.0, f64::max);
        Some(Self { min, max, radius: square.sqrt() })
    }

    /// The bounds of a box's corners.
    pub fn of_box(min: DVec3, max: DVec3) -> Self {
        Self { min, max, radius: (0.5 * max - 0.5 * min).length() }
    }

    /// Centre of the box.
    pub fn centre(&self) -> DVec3 {
        // Halved before the sum, so that the largest finite coordinates do not overflow.
        0.5 * self.min + 0.5 * self.max
    }

    /// The bounds, translated by `offset`.
    pub fn translated(&self, offset: DVec3) -> Self {
        Self { min: self.min + offset, max: self.max + offset, ..*self }
    }

    /// Bounds of both.
    pub fn with(&self, other: &Self) -> Self {
        let both = Self::of_box(self.min.min(other.min), self.max.max(other.max));
        let reach = |part: &Self| part.centre().distance(both.centre()) + part.radius;
        Self { radius: both.radius.min(reach(self).max(reach(other))), ..both }
    }

    /// The bounds, grown by `margin` on all sides.
    pub fn grown(&self, margin: f64) -> Self {
        Self { min: self.min - margin, max: self.max + margin, radius: self.radius + margin }
    }
}
