//! Normals, radii and ellipses of discs.

use crate::geometry::Ellipse;
use glam::{DQuat, DVec3, Vec3};

/// Standard deviations that the disc of a 3D Gaussian covers: the default cut-off.
const CUTOFF: f64 = 2.0;

/// Least aspect.
const LEAST_ASPECT: f64 = 1e-4;

/// A disc; a normal or radius of 0 is missing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    pub normal: Vec3,
    pub radius: f32,
}

/// Tolerance of the squared length of a unit vector that is rounded to f32.
const ROUNDED: f64 = 1e-6;

/// The unit vector along `n`; 0 without a direction.
pub fn unit(n: DVec3) -> Vec3 {
    let square = n.length_squared();
    // Written unit vectors are read back bit by bit.
    if (square - 1.0).abs() < ROUNDED {
        return n.as_vec3();
    }
    if (1e-200..1e200).contains(&square) {
        return (n * square.sqrt().recip()).as_vec3();
    }
    // Scaled by the largest component first: the squares of very long and very short normals exceed float64's range.
    let scaled = n / n.abs().max_element();
    if scaled.is_finite() { scaled.normalize().as_vec3() } else { Vec3::ZERO }
}

/// A valid length; otherwise 0.
pub fn length(value: f64) -> f32 {
    let length = value as f32;
    if length.is_finite() && length > 0.0 { length } else { 0.0 }
}

/// The disc with conjugate semi-axes `u` and `v`: its rim is `u cos φ + v sin φ`. Attributes in `given` take precedence.
pub fn of_axes(given: Disc, u: DVec3, v: DVec3) -> (Disc, Ellipse) {
    // The principal axes, which may differ from the given ones.
    let angle = 0.5 * (2.0 * u.dot(v)).atan2(u.length_squared() - v.length_squared());
    let (sin, cos) = angle.sin_cos();
    let (major, minor) = (u * cos + v * sin, v * cos - u * sin);
    let radius = if given.radius > 0.0 { given.radius } else { length(major.length()) };
    let normal = if given.normal != Vec3::ZERO { given.normal } else { unit(u.cross(v)) };
    let aspect = minor.length() / major.length();
    disc(normal, radius, major, aspect)
}

/// The flat side of a 3D Gaussian with the logarithms of its standard deviations and its rotation, real part first. `given` is the normal
/// or 0; it determines the side.
pub fn of_gaussian(given: Vec3, logs: [f64; 3], [w, x, y, z]: [f64; 4]) -> (Disc, Ellipse) {
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| logs[b].total_cmp(&logs[a]));
    let rotation = DQuat::from_xyzw(x, y, z, w);
    let square = rotation.length_squared();
    if !(square.is_normal() && logs[order[1]].is_finite()) {
        return disc(given, 0.0, DVec3::ZERO, 1.0);
    }
    let rotation = rotation * square.sqrt().recip();
    let axis = |nth: usize| rotation * DVec3::AXES[order[nth]];
    let normal = axis(2).as_vec3();
    let normal = if normal.dot(given) < 0.0 { -normal } else { normal };
    let aspect = (logs[order[1]] - logs[order[0]]).exp();
    disc(normal, length(CUTOFF * logs[order[0]].exp()), axis(0), aspect)
}

fn disc(normal: Vec3, radius: f32, major: DVec3, aspect: f64) -> (Disc, Ellipse) {
    let n = normal.as_dvec3();
    let across = unit(major - n * n.dot(major));
    let usable = across != Vec3::ZERO && aspect.is_finite();
    let ellipse = if usable {
        Ellipse { major: across, aspect: aspect.clamp(LEAST_ASPECT, 1.0) as f32 }
    } else if normal == Vec3::ZERO {
        Ellipse { major: Vec3::X, aspect: 1.0 }
    } else {
        Ellipse::circle(normal)
    };
    (Disc { normal, radius }, ellipse)
}

#[cfg(test)]
mod tests {
    use super::*;

    const NONE: Disc = Disc { normal: Vec3::ZERO, radius: 0.0 };

    #[test]
    fn normals_of_any_length_become_unit() {
        for scale in [1e-300, 1e-30, 1.0, 1e30, 1e300] {
            assert_eq!(unit(DVec3::Y * -scale), -Vec3::Y, "{scale}");
        }
        for none in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::new(1.0, f64::NAN, 0.0)] {
            assert_eq!(unit(none), Vec3::ZERO, "{none}");
        }
    }

    #[test]
    fn conjugate_axes_become_principal_ones() {
        // The unit circle, sheared by 1 in x: the singular values are the golden ratio and its inverse.
        let (disc, ellipse) = of_axes(NONE, DVec3::X, DVec3::new(1.0, 1.0, 0.0));
        let golden = 0.5 * (1.0 + 5f32.sqrt());
        assert!((disc.radius - golden).abs() < 1e-6 && disc.normal == Vec3::Z, "{disc:?}");
        assert!((ellipse.aspect - golden.powi(-2)).abs() < 1e-6, "{ellipse:?}");
        let (disc, ellipse) = of_axes(NONE, DVec3::X, DVec3::Y * 3.0);
        assert!((disc.radius - 3.0).abs() < 1e-6 && ellipse.major.dot(Vec3::Y).abs() > 1.0 - 1e-6);
        assert!((ellipse.aspect - 1.0 / 3.0).abs() < 1e-6);
    }

    #[test]
    fn axes_that_span_no_disc_leave_a_circle_or_nothing() {
        let (disc, ellipse) = of_axes(NONE, DVec3::ZERO, DVec3::NAN);
        assert_eq!((disc, ellipse.aspect), (NONE, 1.0));
        let given = Disc { normal: Vec3::Z, radius: 2.0 };
        let (disc, ellipse) = of_axes(given, DVec3::ZERO, DVec3::ZERO);
        assert_eq!((disc, ellipse.aspect, ellipse.major.dot(Vec3::Z)), (given, 1.0, 0.0));
    }

    #[test]
    fn a_gaussian_faces_along_its_smallest_axis() {
        let half = 0.5f64.sqrt();
        // A quarter turn about x takes y to z: the largest axis is along z, the smallest along x.
        let logs = [-3.0, 1f64.ln(), -1.0];
        let (disc, ellipse) = of_gaussian(Vec3::ZERO, logs, [half * 7.0, half * 7.0, 0.0, 0.0]);
        assert!(disc.normal.abs_diff_eq(Vec3::X, 1e-6) && (disc.radius - 2.0).abs() < 1e-6, "{disc:?}");
        assert!(ellipse.major.z.abs() > 1.0 - 1e-6 && (ellipse.aspect - (-1f32).exp()).abs() < 1e-6);
        let (turned, _) = of_gaussian(-Vec3::X, logs, [half, half, 0.0, 0.0]);
        assert!(turned.normal.abs_diff_eq(-Vec3::X, 1e-6), "the given normal tells the side");
        let (none, _) = of_gaussian(Vec3::ZERO, logs, [0.0; 4]);
        assert_eq!(none, NONE);
    }
}
