//! Cameras: view and projection matrix.

use super::{Bounds, Extent};
use crate::error::{Error, Result};
use glam::{DMat3, DMat4, DVec3, DVec4};

/// View and projection matrix in Vulkan's clip space (x right, y down, `0 ≤ z ≤ w`), for column vectors.
///
/// Supports any rigid view, and perspective and orthographic projections: off-centre, with finite or infinite far plane, reversed or not.
/// [`Camera::look_at`] creates the engine's default: eye space x right, y down, z forward; reversed, infinite far plane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// World to eye space.
    pub view: DMat4,
    /// Eye space to clip space.
    pub projection: DMat4,
    /// Whether clip-space depth decreases with distance (1 at the near plane).
    pub reversed: bool,
}

/// Parameters of the third and fourth row of a projection matrix: how depth relates to distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Projection {
    /// Whether the projection is perspective.
    pub perspective: bool,
    /// +1 if eye space looks along +z, −1 if along −z: the distance in front of the eye is `forward · z`.
    pub forward: f64,
    /// Eye-space distance of the near plane; above 0 in perspective.
    pub near: f64,
    /// Eye-space distance of the far plane; may be infinite in perspective.
    pub far: f64,
}

impl Camera {
    /// A perspective camera at `eye` that looks at `target`, with `up` upwards in the picture.
    ///
    /// `fov_y` is the full vertical angle in radians, `aspect` is width / height, `near` the distance of the near plane.
    pub fn look_at(eye: DVec3, target: DVec3, up: DVec3, fov_y: f64, aspect: f64, near: f64) -> Result<Self> {
        if !(fov_y > 0.0 && fov_y < std::f64::consts::PI) {
            let degrees = fov_y.to_degrees();
            return Err(Error::Usage(format!("the field of view is {degrees}°: give one between 0 and 180")));
        }
        let view = look_at_view(eye, target, up)?;
        let focal = 1.0 / (0.5 * fov_y).tan();
        Ok(Self { view, projection: infinite_reversed(focal / aspect, focal, near), reversed: true })
    }

    /// An orthographic camera; `height` is the picture's height in world units, `near` and `far` are distances from `eye`.
    pub fn orthographic(
        [eye, target, up]: [DVec3; 3],
        height: f64,
        aspect: f64,
        [near, far]: [f64; 2],
    ) -> Result<Self> {
        let view = look_at_view(eye, target, up)?;
        let depth = 1.0 / (far - near);
        let projection = DMat4::from_cols(
            DVec4::new(2.0 / (height * aspect), 0.0, 0.0, 0.0),
            DVec4::new(0.0, 2.0 / height, 0.0, 0.0),
            DVec4::new(0.0, 0.0, -depth, 0.0),
            DVec4::new(0.0, 0.0, far * depth, 1.0),
        );
        Ok(Self { view, projection, reversed: true })
    }

    /// A perspective camera that [frames](Extent::pose) a model, with `up` upwards in the picture.
    ///
    /// `fov_y` is the full vertical angle in radians, `aspect` is width / height.
    ///
    /// # Errors
    /// [`Error::Usage`] if the field of view is out of range or `up` is zero.
    pub fn framing(extent: &Extent, up: DVec3, fov_y: f64, aspect: f64) -> Result<Self> {
        extent.pose(up, fov_y.to_degrees(), aspect)?.camera(&extent.bounds(), aspect)
    }

    /// A near plane in front of everything in `bounds` that a viewer at `eye` may look at. With reversed float depth, a small one costs no
    /// precision.
    pub fn near_for(eye: DVec3, bounds: &Bounds) -> f64 {
        let scale = bounds.radius.max((eye - bounds.centre()).length());
        if scale > 0.0 { 1e-5 * scale } else { 1e-5 }
    }

    /// World to clip space.
    pub fn world_to_clip(&self) -> DMat4 {
        self.projection * self.view
    }

    /// Eye-space distance of a depth from 0 to 1; infinite at an infinite far plane.
    ///
    /// # Errors
    /// As [`Camera::projection`].
    pub fn distance(&self, depth: f64) -> Result<f64> {
        let forward = self.projection()?.forward;
        let (z, w) = (self.projection.row(2), self.projection.row(3));
        Ok(forward * (z.w - depth * w.w) / (depth * w.z - z.z))
    }

    /// Parameters of the projection's depth rows.
    ///
    /// # Errors
    /// [`Error::Usage`] for a view that is not a rotation, possibly mirrored, with a translation, and for an unsupported projection.
    pub fn projection(&self) -> Result<Projection> {
        let (z, w) = (self.projection.row(2), self.projection.row(3));
        let refuse = |cause: &str| Err(Error::Usage(format!("the projection matrix {cause}")));
        if !self.projection.is_finite() || !self.view.is_finite() {
            return refuse("or the view matrix holds a value that is not finite");
        }
        if !is_rigid(&self.view) {
            return Err(Error::Usage(
                "the view matrix scales or shears: give a rotation and a translation, and scale the scene or the projection".into(),
            ));
        }
        if z.x != 0.0 || z.y != 0.0 {
            return refuse("has an oblique near plane: use one whose depth rows depend on z alone");
        }
        if w.x != 0.0 || w.y != 0.0 || (w.z != 0.0) == (w.w != 0.0) {
            return refuse("has a fourth row that is neither (0, 0, ±k, 0) nor (0, 0, 0, k)");
        }
        let perspective = w.z != 0.0;
        // Depth as a function of the distance d = forward · z: a + b / d in perspective, otherwise a d + b.
        let (forward, at_zero, at_one) = if perspective {
            let (a, b) = (z.z / w.z, z.w / w.z.abs());
            (w.z.signum(), -b / a, b / (1.0 - a))
        } else {
            let forward = if (z.z / w.w > 0.0) == self.reversed { -1.0 } else { 1.0 };
            let (a, b) = (forward * z.z / w.w, z.w / w.w);
            (forward, -b / a, (1.0 - b) / a)
        };
        let (near, far) = if self.reversed { (at_one, at_zero) } else { (at_zero, at_one) };
        // An infinite far plane may be −∞ or, from single-precision matrices, a huge negative number.
        let far = if perspective && (far.is_nan() || far < 0.0) { f64::INFINITY } else { far };
        if !(near.is_finite() && far > near && (near > 0.0 || !perspective)) {
            return refuse(&format!(
                "puts the near plane at {near} and the far plane at {far}; is `reversed` right?"
            ));
        }
        Ok(Projection { perspective, forward, near, far })
    }
}

/// Tolerance of lengths and right angles in a single-precision view.
const LEAST_RIGID: f64 = 1e-4;

/// Whether lengths and angles are preserved.
fn is_rigid(view: &DMat4) -> bool {
    let turn = DMat3::from_mat4(*view);
    let off = turn.transpose() * turn - DMat3::IDENTITY;
    off.to_cols_array().iter().all(|entry| entry.abs() < LEAST_RIGID) && view.row(3) == DVec4::W
}

fn infinite_reversed(focal_x: f64, focal_y: f64, near: f64) -> DMat4 {
    DMat4::from_cols(
        DVec4::new(focal_x, 0.0, 0.0, 0.0),
        DVec4::new(0.0, focal_y, 0.0, 0.0),
        DVec4::new(0.0, 0.0, 0.0, 1.0),
        DVec4::new(0.0, 0.0, near, 0.0),
    )
}

/// World to eye space: x right, y down, z forward.
pub(super) fn look_at_view(eye: DVec3, target: DVec3, up: DVec3) -> Result<DMat4> {
    let usage =
        |cause: &str| Error::Usage(format!("the camera {cause}: move the eye, the target or the up vector"));
    if !(eye.is_finite() && target.is_finite() && up.is_finite()) {
        return Err(usage("has a coordinate that is not finite"));
    }
    let away = target - eye;
    if !away.length_squared().is_finite() {
        return Err(usage("is too far from its target for float64"));
    }
    let forward = away.try_normalize().ok_or_else(|| usage("is at its target"))?;
    let right = forward.cross(up).try_normalize().ok_or_else(|| usage("looks along its up vector"))?;
    let down = forward.cross(right);
    let rotation = glam::DMat3::from_cols(right, down, forward).transpose();
    Ok(DMat4::from_mat3(rotation) * DMat4::from_translation(-eye))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dcamera::{lh, rh};

    fn camera(projection: DMat4, reversed: bool) -> Camera {
        Camera { view: DMat4::IDENTITY, projection, reversed }
    }

    fn close(a: f64, b: f64) -> bool {
        a == b || (a - b).abs() < 1e-9 * b.abs()
    }

    #[test]
    fn planes_are_read_off_every_kind_of_matrix() {
        // glam's rh looks along −z, lh along +z.
        let ortho = |near, far| rh::proj::directx::orthographic(-1.0, 1.0, -1.0, 1.0, near, far);
        let cases = [
            (rh::proj::directx::perspective(1.0, 1.5, 0.5, 80.0), false, -1.0, 0.5, 80.0),
            (lh::proj::directx::perspective(1.0, 1.5, 0.5, 80.0), false, 1.0, 0.5, 80.0),
            (lh::proj::directx::perspective(1.0, 1.5, 80.0, 0.5), true, 1.0, 0.5, 80.0),
            (rh::proj::directx::perspective_infinite(1.0, 1.5, 0.25), false, -1.0, 0.25, f64::INFINITY),
            (
                rh::proj::directx::perspective_infinite_reverse(1.0, 1.5, 0.25),
                true,
                -1.0,
                0.25,
                f64::INFINITY,
            ),
            (3.0 * infinite_reversed(1.0, 1.0, 0.25), true, 1.0, 0.25, f64::INFINITY),
            (ortho(0.5, 80.0), false, -1.0, 0.5, 80.0),
            (ortho(80.0, 0.5), true, -1.0, 0.5, 80.0),
            (lh::proj::directx::orthographic(-1.0, 1.0, -1.0, 1.0, -3.0, 80.0), false, 1.0, -3.0, 80.0),
        ];
        for (i, (matrix, reversed, forward, near, far)) in cases.into_iter().enumerate() {
            let p = camera(matrix, reversed).projection().unwrap();
            assert_eq!(p.forward, forward, "case {i}");
            assert!(close(p.near, near) && close(p.far, far), "case {i}: {p:?}");
        }
    }

    #[test]
    fn depths_have_their_distances() {
        let (near, far) = (0.5, 80.0);
        let cases = [
            (rh::proj::directx::perspective(1.0, 1.5, near, far), false),
            (lh::proj::directx::perspective(1.0, 1.5, far, near), true),
            (rh::proj::directx::perspective_infinite_reverse(1.0, 1.5, near), true),
            (rh::proj::directx::orthographic(-1.0, 1.0, -1.0, 1.0, far, near), true),
            (lh::proj::directx::orthographic(-1.0, 1.0, -1.0, 1.0, near, far), false),
        ];
        for (matrix, reversed) in cases {
            let camera = camera(matrix, reversed);
            let forward = camera.projection().unwrap().forward;
            for distance in [0.5, 3.0, 79.0] {
                let clip = matrix * DVec4::new(0.0, 0.0, forward * distance, 1.0);
                assert!(close(camera.distance(clip.z / clip.w).unwrap(), distance), "{matrix} {distance}");
            }
        }
    }

    #[test]
    fn unusable_matrices_are_refused() {
        let good = rh::proj::directx::perspective(1.0, 1.5, 0.5, 80.0);
        let mut oblique = good;
        oblique.x_axis.z = 0.1;
        let mut skew = good;
        skew.x_axis.w = 0.1;
        let mut nan = good;
        nan.y_axis.y = f64::NAN;
        for matrix in [oblique, skew, nan, DMat4::ZERO] {
            assert!(camera(matrix, false).projection().is_err(), "{matrix}");
        }
        assert!(camera(good, true).projection().is_err(), "wrong depth direction");
        assert!(Camera::look_at(DVec3::X, DVec3::X, DVec3::Y, 1.0, 1.0, 0.1).is_err());
        assert!(Camera::look_at(DVec3::Y, DVec3::ZERO, DVec3::Y, 1.0, 1.0, 0.1).is_err());
    }

    #[test]
    fn a_framed_box_lies_inside_the_picture() {
        let bounds = Bounds::of_box(DVec3::new(-1.0, 5.0, 2.0), DVec3::new(3.0, 6.0, 9.0));
        for aspect in [0.3, 1.0, 2.5] {
            let clip =
                Camera::framing(&Extent::from(&bounds), DVec3::Y, 0.8, aspect).unwrap().world_to_clip();
            for corner in 0..8 {
                let pick =
                    |axis: usize| if corner >> axis & 1 == 0 { bounds.min[axis] } else { bounds.max[axis] };
                let p = clip * DVec4::new(pick(0), pick(1), pick(2), 1.0);
                assert!(p.w > 0.0 && p.x.abs() < p.w && p.y.abs() < p.w && p.z < p.w, "{p}");
            }
        }
    }
}
