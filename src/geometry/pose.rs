//! Camera poses, as users write them.

use super::{Bounds, Camera};
use crate::error::{Error, Result};
use glam::DVec3;

/// Position, direction and field of view of a camera, world space. Near and far plane follow from the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position of the camera.
    pub eye: DVec3,
    /// Point in the middle of the picture.
    pub target: DVec3,
    /// Upward direction in the picture, of any length.
    pub up: DVec3,
    /// Vertical extent of the picture.
    pub span: Span,
}

/// Vertical extent of a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Span {
    /// Perspective: vertical field of view, degrees.
    Angle(f64),
    /// Orthographic: height, world units.
    Height(f64),
}

impl Pose {
    /// The camera for a scene with these bounds, and a picture with this width / height.
    ///
    /// # Errors
    /// As [`Pose::check`].
    pub fn camera(&self, bounds: &Bounds, aspect: f64) -> Result<Camera> {
        let Self { eye, target, up, span } = *self;
        match span {
            Span::Angle(degrees) => {
                let near = Camera::near_for(eye, bounds);
                Camera::look_at(eye, target, up, degrees.to_radians(), aspect, near)
            }
            Span::Height(height) => {
                check_height(height)?;
                let reach = (target - eye).length();
                let middle = ((target - eye) / reach).dot(bounds.centre() - eye);
                let radius = 1.01 * bounds.radius.max(reach);
                let planes = [middle - radius, middle + radius];
                Camera::orthographic([eye, target, up], height, aspect, planes)
            }
        }
    }

    /// Validates the pose.
    ///
    /// # Errors
    /// [`Error::Usage`] if eye and target coincide, if the camera looks along its up vector, or if the field of view or height is out of
    /// range.
    pub fn check(&self) -> Result<()> {
        let bounds = Bounds::of_box(DVec3::splat(-1.0), DVec3::ONE);
        self.camera(&bounds, 1.0).map(drop)
    }
}

fn check_height(height: f64) -> Result<()> {
    if height.is_finite() && height > 0.0 {
        Ok(())
    } else {
        Err(Error::Usage(format!(
            "the height of the picture is {height}: give a finite number above 0, in the scene's unit"
        )))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec4;

    const POSE: Pose = Pose {
        eye: DVec3::new(1.0, 2.0, 8.0),
        target: DVec3::new(1.0, 2.0, 3.0),
        up: DVec3::new(0.1, 2.0, 0.0),
        span: Span::Angle(60.0),
    };

    fn bounds() -> Bounds {
        Bounds::of_box(DVec3::new(-4.0, 0.0, -3.0), DVec3::new(3.0, 6.0, 9.0))
    }

    #[test]
    fn a_picture_has_the_declared_span() {
        let half = 5.0 * 30f64.to_radians().tan();
        for (span, half) in [(POSE.span, half), (Span::Height(3.0), 1.5)] {
            let clip = Pose { span, ..POSE }.camera(&bounds(), 2.0).unwrap().world_to_clip();
            let seen = |across: f64, up: f64| -> DVec4 {
                let above = DVec3::new(0.1, 2.0, 0.0).normalize();
                let right = DVec3::NEG_Z.cross(above);
                let at = clip * (POSE.target + across * right + up * above).extend(1.0);
                at / at.w
            };
            assert!(seen(0.0, 0.0).truncate().truncate().length() < 1e-12, "{span:?}");
            assert!((seen(0.0, half).y + 1.0).abs() < 1e-12, "{span:?}: {}", seen(0.0, half));
            assert!((seen(2.0 * half, 0.0).x - 1.0).abs() < 1e-12, "{span:?}");
        }
    }

    #[test]
    fn parallel_planes_hold_the_whole_scene() {
        for eye in [POSE.eye, DVec3::new(1.0, 2.0, 3.1), DVec3::new(1.0, 2.0, 900.0)] {
            let pose = Pose { eye, span: Span::Height(1.0), ..POSE };
            let planes = pose.camera(&bounds(), 1.0).unwrap().projection().unwrap();
            let middle = eye.z - bounds().centre().z;
            assert!(planes.near <= middle - bounds().radius && planes.far >= middle + bounds().radius);
        }
    }

    #[test]
    fn what_is_no_camera_is_refused() {
        let nan = f64::NAN;
        let heights = [0.0, -1.0, nan, f64::INFINITY].map(Span::Height);
        let angles = [0.0, 180.0, nan].map(Span::Angle);
        for span in heights.into_iter().chain(angles) {
            assert!(Pose { span, ..POSE }.check().is_err(), "{span:?}");
        }
        assert!(POSE.check().is_ok());
        assert!(Pose { eye: POSE.target, ..POSE }.check().is_err());
        assert!(Pose { up: DVec3::Z, ..POSE }.check().is_err());
        assert!(Pose { up: DVec3::splat(nan), ..POSE }.check().is_err());
        assert!(Pose { eye: POSE.target, span: Span::Height(1.0), ..POSE }.check().is_err());
    }
}
