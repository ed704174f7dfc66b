//! Single rays of a picture.

use super::traceable::Traceable;
use crate::error::Result;
use crate::geometry::Camera;
use crate::settings::{Settings, Shading};
use crate::verify::reference::{Projector, Shine, lit};
use glam::{DVec2, DVec3};

/// The surface that a ray hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// Shaded with [`Shading::Lit`], the albedo otherwise; linear RGB.
    pub colour: DVec3,
    /// Distance along the view, in the scene's unit.
    pub depth: f64,
    /// World-space unit normal that faces the eye.
    pub normal: DVec3,
}

/// A scene seen through a camera.
pub struct Eye<'a, S: ?Sized> {
    scene: &'a S,
    projector: Projector,
    settings: &'a Settings,
}

impl<'a, S: Traceable + ?Sized> Eye<'a, S> {
    /// Prepares a picture of `size` = width and height in px.
    ///
    /// # Errors
    /// [`Error::Usage`](crate::Error::Usage) for invalid settings, sizes and cameras.
    pub fn new(scene: &'a S, camera: &Camera, settings: &'a Settings, size: [u32; 2]) -> Result<Self> {
        Ok(Self { scene, projector: Projector::new(camera, size, settings)?, settings })
    }

    /// The surface at a position in px from the picture's top left, between the near and the far plane.
    pub fn hit(&self, at: DVec2) -> Option<SurfaceHit> {
        let [near, far] = self.projector.planes();
        let (origin, step) = self.projector.ray(at);
        let hit = self.scene.trace(origin + near * step, step)?;
        let depth = near + hit.t;
        if depth > far {
            return None;
        }
        let viewer = self.projector.to_viewer(at);
        let normal = if hit.normal.dot(viewer) < 0.0 { -hit.normal } else { hit.normal };
        let lighting = &self.settings.lighting;
        let albedo = DVec3::from(hit.albedo.unwrap_or(lighting.albedo.map(f64::from)));
        let colour = match self.settings.shading {
            Shading::Lit => lit(lighting, Shine::of_frame(lighting), albedo, normal, viewer),
            _ => albedo,
        };
        Some(SurfaceHit { colour, depth, normal })
    }
}
