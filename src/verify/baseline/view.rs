//! A frame's camera in the form of the inner loops: relative to the scene's origin, and to the eye.

use crate::error::{Error, Result};
use crate::geometry::Camera;
use crate::settings::Settings;
use glam::{DMat3, DVec2, DVec3, DVec4, Vec2};

/// A camera for a picture of some size.
///
/// The *depth key* of a point is greater for nearer points and affine on the screen for every plane: 1 / distance in
/// perspective, `near` − distance in orthographic projection.
#[derive(Clone, Debug)]
pub(super) struct View {
    pub perspective: bool,
    /// Width and height, px.
    pub size: [u32; 2],
    /// Point where the rays meet, relative to the scene's origin; for parallel rays, the origin of eye space.
    pub eye: DVec3,
    /// Unit viewing direction.
    pub forward: DVec3,
    /// World vectors relative to the eye to homogeneous pixels: x, y, and the distance, by which perspective divides.
    pub pixel: DMat3,
    /// The pixel of the eye for parallel rays; 0 in perspective.
    pub middle: DVec2,
    /// Pixel (x, y, 1) to a world vector relative to the eye: on the pixel's ray, at distance 1 in perspective and 0
    /// otherwise.
    pub ray: DMat3,
    /// Determinant of the map to homogeneous pixels, or to the picture's plane.
    pub jacobian: f32,
    /// Distances of the near and the far plane.
    pub near: f64,
    pub far: f64,
    /// Depth keys of the far and the near plane.
    pub depth_keys: [f32; 2],
}

impl View {
    /// Unit direction to the eye from a position relative to it.
    #[inline]
    pub fn to_eye(&self, position: DVec3) -> DVec3 {
        if self.perspective { -position.normalize_or_zero() } else { -self.forward }
    }

    /// Prepares a camera; fails on invalid cameras and sizes.
    pub fn new(camera: &Camera, size: [u32; 2], origin: DVec3) -> Result<Self> {
        let depth = camera.projection()?;
        check_size(size)?;
        let rows = pixel_rows(camera, size);
        let forward = depth.forward * camera.view.row(2).truncate().normalize();
        let pixel = DMat3::from_cols(rows[0].truncate(), rows[1].truncate(), forward).transpose();
        let inverse = pixel.inverse();
        let eye = if depth.perspective {
            inverse * DVec3::new(-rows[0].w, -rows[1].w, -rows[2].w)
        } else {
            camera.view.inverse().w_axis.truncate()
        };
        if !(inverse.is_finite() && eye.is_finite()) {
            let cause = "the camera's matrices flatten the picture: give them an inverse";
            return Err(Error::Usage(cause.into()));
        }
        let middle = if depth.perspective {
            DVec2::ZERO
        } else {
            DVec2::new(rows[0].dot(eye.extend(1.0)), rows[1].dot(eye.extend(1.0)))
        };
        let base = if depth.perspective { inverse.z_axis } else { -(inverse * middle.extend(0.0)) };
        Ok(Self {
            perspective: depth.perspective,
            size,
            eye: eye - origin,
            forward,
            pixel,
            middle,
            ray: DMat3::from_cols(inverse.x_axis, inverse.y_axis, base),
            jacobian: pixel.determinant().abs() as f32,
            near: depth.near,
            far: depth.far,
            depth_keys: if depth.perspective {
                [1.0 / depth.far, 1.0 / depth.near]
            } else {
                [depth.near - depth.far, 0.0]
            }
            .map(|depth_key| depth_key as f32),
        })
    }

    /// Largest depth key that a disc shows whose nearest point has the key `disc`: see [`Settings::MOST_RISE`].
    pub fn shown(&self, disc: f32) -> f32 {
        let pixel = self.ray.x_axis.length().max(self.ray.y_axis.length());
        let rise = (Settings::MOST_RISE * pixel) as f32;
        if self.perspective { disc * (1.0 + rise) } else { disc + rise }
    }

    /// Width and height, px.
    pub fn extent(&self) -> Vec2 {
        Vec2::from_array(self.size.map(|side| side as f32))
    }
}

/// Rows of the map from the world to homogeneous pixels.
fn pixel_rows(camera: &Camera, size: [u32; 2]) -> [DVec4; 3] {
    let clip = camera.world_to_clip();
    let scale = camera.projection.row(3).abs().max_element();
    let [x, y, w] = [0, 1, 3].map(|row| clip.row(row) / scale);
    let [width, height] = size.map(f64::from);
    [0.5 * width * (x + w), 0.5 * height * (y + w), w]
}

/// Greatest side of a picture, px: pixel coordinates have 16 bits.
const MOST_SIDE: u32 = u16::MAX as u32;

fn check_size(size: [u32; 2]) -> Result<()> {
    if size.iter().all(|side| (1..=MOST_SIDE).contains(side)) {
        return Ok(());
    }
    Err(Error::Usage(format!("the picture is {}x{} px: give 1 to {MOST_SIDE} px a side", size[0], size[1])))
}
