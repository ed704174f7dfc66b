//! Surfaces of which exact images can be rendered.

use crate::geometry::Bounds;
use crate::verify::scenes::Surface;
use glam::DVec3;

/// Intersection of a ray with a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance, in lengths of the ray's direction.
    pub t: f64,
    /// Unit normal, of either side.
    pub normal: DVec3,
    /// Albedo, linear RGB; `None` for the lighting's.
    pub albedo: Option<[f64; 3]>,
}

/// A scene for ray tracing.
pub trait Traceable: Sync {
    /// The nearest intersection with a ray at `t > 0`. `direction` may have any length.
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit>;

    /// Bounding box and sphere.
    fn bounds(&self) -> Bounds;
}

impl<S: Surface + ?Sized> Traceable for S {
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let hit = Surface::trace(self, origin, direction)?;
        Some(Hit { t: hit.t, normal: hit.normal, albedo: Some(hit.albedo) })
    }

    fn bounds(&self) -> Bounds {
        Surface::bounds(self)
    }
}

impl Traceable for Box<dyn Surface> {
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        Traceable::trace(&**self, origin, direction)
    }

    fn bounds(&self) -> Bounds {
        Traceable::bounds(&**self)
    }
}
