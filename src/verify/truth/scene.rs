//! What exact images are made of.

use crate::geometry::Bounds;
use crate::verify::scenes::Surface;
use glam::DVec3;

/// Where a ray meets a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance in lengths of the ray's direction.
    pub t: f64,
    /// Unit normal of either side.
    pub normal: DVec3,
    /// Albedo, linear RGB; that of the lighting where the scene has none.
    pub albedo: Option<[f64; 3]>,
}

/// What rays can be traced against.
pub trait Scene: Sync {
    /// The nearest point that a ray meets at `t > 0`. `direction` may have any length.
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit>;

    /// A box and a sphere that hold it.
    fn bounds(&self) -> Bounds;
}

impl<S: Surface + ?Sized> Scene for S {
    fn trace(&self, origin: DVec3, direction: DVec3) -> Option<Hit> {
        let hit = Surface::trace(self, origin, direction)?;
        Some(Hit { t: hit.t, normal: hit.normal, albedo: Some(hit.albedo) })
    }

    fn bounds(&self) -> Bounds {
        Surface::bounds(self)
    }
}
