//! Similarity transforms: rotation, uniform scale and translation.

use crate::error::Cause;
use crate::geometry::{Bounds, Camera};
use glam::{DMat3, DMat4, DQuat, DVec3};

/// Relative tolerance for axes of equal length and right angles. Single-precision matrices are off by 10⁻⁶, and a shear that is invisible
/// at a thousandth of a pixel is none.
const TOLERANCE: f64 = 1e-5;
/// Smallest and largest scale: beyond, the scene has no float32 coordinates in eye space.
const SCALES: [f64; 2] = [1e-15, 1e15];

/// Maps `x` to `scale · rotation · x + translation`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Similarity {
    scale: f64,
    rotation: DMat3,
    translation: DVec3,
}

impl Similarity {
    /// The identity.
    pub(crate) const IDENTITY: Self =
        Self { scale: 1.0, rotation: DMat3::IDENTITY, translation: DVec3::ZERO };

    /// The similarity of a matrix. The error is a predicate of the matrix.
    pub(crate) fn of(transform: &DMat4) -> Result<Self, Cause> {
        if !transform.is_finite() {
            return Err("holds a value that is not finite".into());
        }
        let last = transform.row(3);
        if last.truncate() != DVec3::ZERO || last.w != 1.0 {
            return Err(format!("has a last row of {last}, not (0, 0, 0, 1)").into());
        }
        let axes = DMat3::from_mat4(*transform);
        let lengths = [axes.x_axis, axes.y_axis, axes.z_axis].map(DVec3::length);
        let [least, most] = [
            lengths.iter().copied().fold(f64::INFINITY, f64::min),
            lengths.iter().copied().fold(0.0, f64::max),
        ];
        if least == 0.0 {
            return Err("is singular".into());
        }
        if !(least >= SCALES[0] && most <= SCALES[1]) {
            let [low, high] = SCALES;
            return Err(format!("scales by {least:e}, which is not within {low:e} to {high:e}").into());
        }
        let unit =
            DMat3::from_cols(axes.x_axis / lengths[0], axes.y_axis / lengths[1], axes.z_axis / lengths[2]);
        let tilts =
            [unit.x_axis.dot(unit.y_axis), unit.y_axis.dot(unit.z_axis), unit.z_axis.dot(unit.x_axis)];
        if tilts.iter().any(|tilt| tilt.abs() > TOLERANCE) {
            return Err("shears".into());
        }
        if most - least > TOLERANCE * most {
            return Err(format!("scales by {least} along one axis and by {most} along another").into());
        }
        if unit.determinant() < 0.0 {
            return Err("mirrors".into());
        }
        let rotation = DMat3::from_quat(DQuat::from_mat3(&unit).normalize());
        let scale = (lengths[0] * lengths[1] * lengths[2]).cbrt();
        Ok(Self { scale, rotation, translation: transform.w_axis.truncate() })
    }

    /// Scale factor of lengths.
    pub(crate) fn scale(&self) -> f64 {
        self.scale
    }

    /// Rotation of directions from the scene's space to the world's.
    pub(crate) fn rotation(&self) -> DMat3 {
        self.rotation
    }

    /// Transforms a camera from the world's space to the scene's. The view stays rigid; distances, including near and far plane, become `1
    /// / scale` of the world's.
    pub(crate) fn seen_by(&self, camera: &Camera) -> Camera {
        let mut rigid = DMat4::from_mat3(self.rotation);
        rigid.w_axis = self.translation.extend(1.0);
        let mut view = camera.view * rigid;
        view.w_axis = (view.w_axis.truncate() / self.scale).extend(1.0);
        Camera {
            view,
            projection: camera.projection * DMat4::from_scale(DVec3::splat(self.scale)),
            ..*camera
        }
    }

    /// Transforms bounds.
    pub(crate) fn bounds(&self, own: &Bounds) -> Bounds {
        let centre = self.scale * (self.rotation * own.centre()) + self.translation;
        let half = 0.5 * own.max - 0.5 * own.min;
        let turn = self.rotation;
        let reach = self.scale
            * (half.x * turn.x_axis.abs() + half.y * turn.y_axis.abs() + half.z * turn.z_axis.abs());
        let radius = self.scale * own.radius;
        // The box of a rotated box is larger than needed; the sphere is not.
        let reach = reach.min(DVec3::splat(radius));
        Bounds { min: centre - reach, max: centre + reach, radius }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turned() -> DMat4 {
        let rotation = DQuat::from_axis_angle(DVec3::new(1.0, -2.0, 0.5).normalize(), 1.1);
        DMat4::from_scale_rotation_translation(DVec3::splat(2.5), rotation, DVec3::new(3.0, -1.0, 7.0))
    }

    #[test]
    fn a_similarity_is_read_off_its_matrix() {
        let matrix = turned();
        // A single-precision copy is a similarity, too.
        for (matrix, most) in [(matrix, 1e-12), (matrix.as_mat4().as_dmat4(), 1e-6)] {
            let found = Similarity::of(&matrix).unwrap();
            assert!((found.scale() - 2.5).abs() < most);
            let square = found.rotation().transpose() * found.rotation();
            assert!(square.abs_diff_eq(DMat3::IDENTITY, 1e-14));
            let point = DVec3::new(0.3, -4.0, 2.0);
            let placed = found.scale * (found.rotation * point) + found.translation;
            assert!(placed.abs_diff_eq(turned().transform_point3(point), 50.0 * most));
        }
    }

    #[test]
    fn a_camera_sees_what_is_placed_where_the_world_has_it() {
        let eye = DVec3::new(9.0, 2.0, -4.0);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.9, 1.5, 0.1).unwrap();
        let parallel = Camera::orthographic([eye, DVec3::ZERO, DVec3::Y], 5.0, 1.5, [0.5, 80.0]).unwrap();
        let placed = Similarity::of(&turned()).unwrap();
        for camera in [camera, parallel] {
            let own = placed.seen_by(&camera);
            let point = DVec3::new(0.4, 0.2, -0.7);
            let [a, b] = [
                own.world_to_clip().project_point3(point),
                camera.world_to_clip().project_point3(turned().transform_point3(point)),
            ];
            assert!(a.abs_diff_eq(b, 1e-12), "{a} {b}");
            let turn = DMat3::from_mat4(own.view);
            assert!((turn.transpose() * turn).abs_diff_eq(DMat3::IDENTITY, 1e-14));
            let [near, world] = [own, camera].map(|camera| camera.projection().unwrap().near);
            assert!((2.5 * near - world).abs() < 1e-12);
        }
    }

    #[test]
    fn bounds_hold_what_is_placed() {
        let own = Bounds::of_box(DVec3::new(-1.0, 2.0, 0.0), DVec3::new(3.0, 2.5, 8.0));
        let placed = Similarity::of(&turned()).unwrap().bounds(&own);
        assert!((placed.radius - 2.5 * own.radius).abs() < 1e-12);
        for corner in 0..8 {
            let pick = |axis: usize| if corner >> axis & 1 == 0 { own.min[axis] } else { own.max[axis] };
            let point = turned().transform_point3(DVec3::new(pick(0), pick(1), pick(2)));
            assert!(point.cmpge(placed.min - 1e-12).all() && point.cmple(placed.max + 1e-12).all());
        }
    }

    #[test]
    fn all_else_is_refused_by_its_name() {
        let scaled = |x, y, z| DMat4::from_scale(DVec3::new(x, y, z));
        let mut shear = DMat4::IDENTITY;
        shear.y_axis.x = 0.01;
        let mut projective = DMat4::IDENTITY;
        projective.z_axis.w = 0.1;
        let mut nan = turned();
        nan.w_axis.x = f64::NAN;
        for (matrix, expected) in [
            (nan, "not finite"),
            (scaled(1.0, f64::INFINITY, 1.0), "not finite"),
            (projective, "last row"),
            (DMat4::ZERO, "last row"),
            (scaled(1.0, 0.0, 1.0), "singular"),
            (scaled(1.0, 1.001, 1.0), "along one axis and by 1.001 along another"),
            (scaled(-1.0, 1.0, 1.0), "mirrors"),
            (scaled(-2.0, -2.0, -2.0), "mirrors"),
            (shear, "shears"),
            (scaled(1e-20, 1e-20, 1e-20), "scales by 1e-20"),
            (scaled(1e20, 1e20, 1e20), "scales by 1e20"),
        ] {
            let text = Similarity::of(&matrix).unwrap_err().to_string();
            assert!(text.contains(expected), "`{expected}` is not in `{text}`");
        }
    }
}
