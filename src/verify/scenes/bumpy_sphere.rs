//! The comparison scene: a sphere with bumps, `r = 1 + 0.1 sin 5θ sin 5φ`, in checker colours, with exact ray
//! intersections.
//!
//! θ is the polar angle from +y, φ the azimuth from +x towards +z. One definition of the surface serves sampling and
//! tracing.

mod trace;

pub(super) use trace::meet;
pub use trace::{Hit, trace};

use crate::geometry::{Colours, Surfels};
use glam::{DVec3, Vec3};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Least distance of the surface from the centre.
const LEAST: f64 = 0.9;
/// Greatest distance of the surface from the centre.
pub(super) const GREATEST: f64 = 1.1;
/// Disc radius in mean spacings √(area / points).
const OVERLAP: f64 = 1.5;

/// The surface in one direction from the centre.
struct Shape {
    /// Distance from the centre.
    radius: f64,
    /// Gradient of that distance over the unit sphere, a vector tangent to the sphere.
    slope: DVec3,
}

/// cos 5a and sin 5a / sin a.
fn fifth(cos: f64, sin: f64) -> (f64, f64) {
    let (c, s) = (cos * cos, sin * sin);
    (cos * (c * c - 10.0 * c * s + 5.0 * s * s), 5.0 * c * c - 10.0 * c * s + s * s)
}

/// The surface in the direction of the unit vector `u`. At the poles, where the surface has a cone-like tip and no gradient, φ is taken as 0.
fn shape(u: DVec3) -> Shape {
    // Faster than `hypot`, as this dominates the cost of a traced ray; the coordinates of a unit vector do not
    // overflow.
    let sin_theta = (u.x * u.x + u.z * u.z).sqrt();
    let (cos_phi, sin_phi) = if sin_theta > 0.0 { (u.x / sin_theta, u.z / sin_theta) } else { (1.0, 0.0) };
    let ((cos_5theta, theta_ratio), (cos_5phi, phi_ratio)) = (fifth(u.y, sin_theta), fifth(cos_phi, sin_phi));
    let (sin_5theta, sin_5phi) = (sin_theta * theta_ratio, sin_phi * phi_ratio);
    let along_theta = DVec3::new(u.y * cos_phi, -sin_theta, u.y * sin_phi);
    let along_phi = DVec3::new(-sin_phi, 0.0, cos_phi);
    Shape {
        radius: 1.0 + 0.1 * sin_5theta * sin_5phi,
        slope: 0.5 * cos_5theta * sin_5phi * along_theta + 0.5 * theta_ratio * cos_5phi * along_phi,
    }
}

/// Distance from the centre in the direction of the unit vector `u`, and its gradient over the unit sphere.
pub(super) fn radius_and_slope(u: DVec3) -> (f64, DVec3) {
    let shape = shape(u);
    (shape.radius, shape.slope)
}

/// `|p| − r`: negative inside, 0 on the surface, positive outside; and its gradient, which points outwards. `p` is not the centre.
pub fn implicit(p: DVec3) -> (f64, DVec3) {
    let length = p.length();
    let u = p / length;
    let shape = shape(u);
    (length - shape.radius, u - shape.slope / length)
}

/// The checker's sRGB colour in the direction of `p`: 16 squares from pole to pole, 32 around.
pub fn colour(p: DVec3) -> [u8; 3] {
    let theta = p.x.hypot(p.z).atan2(p.y);
    let phi = p.z.atan2(p.x).rem_euclid(TAU);
    let field = (theta * 16.0 / PI).floor() + (phi * 32.0 / TAU).floor();
    if field % 2.0 > 0.0 { [230, 60, 40] } else { [240, 235, 220] }
}

/// Area of the surface, by Simpson's rule over θ and the trapezoidal rule over one of the five periods of φ; correct to 10⁻⁹.
pub fn area() -> f64 {
    const THETA: u32 = 512;
    const PHI: u32 = 128;
    let ring = |i: u32| {
        let theta = PI * f64::from(i) / f64::from(THETA);
        let element = |j: u32| {
            let shape = shape(direction(theta, TAU / 5.0 * f64::from(j) / f64::from(PHI)));
            shape.radius * shape.radius.hypot(shape.slope.length())
        };
        theta.sin() * (0..PHI).map(element).sum::<f64>() * TAU / f64::from(PHI)
    };
    let weight = |i: u32| if i % 2 == 1 { 4.0 } else { 2.0 };
    // The integrand is 0 at both ends.
    (1..THETA).map(|i| weight(i) * ring(i)).sum::<f64>() * PI / f64::from(3 * THETA)
}

/// Samples the surface: a Fibonacci lattice on the sphere, jittered by a quarter of the spacing and projected to the
/// surface. The same `points` and `seed` give the same surfels on every machine up to rounding. Centres lie on the
/// surface to within f32, normals are exact, and every radius is 1.5 √(area / points). The order is along the lattice,
/// from pole to pole.
pub fn sample(points: u32, seed: u64) -> Surfels {
    let rng = Pcg64::seed_from_u64(seed);
    let surfel = |i: u32| {
        let u = jittered(i, points, rng.clone());
        let shape = shape(u);
        let position = u * shape.radius;
        let [r, g, b] = colour(u);
        (position.as_vec3(), (u - shape.slope / shape.radius).normalize().as_vec3(), [r, g, b, 0])
    };
    let surfels: Vec<(Vec3, Vec3, [u8; 4])> = (0..points).into_par_iter().map(surfel).collect();
    Surfels {
        origin: DVec3::ZERO,
        positions: surfels.par_iter().map(|surfel| surfel.0).collect(),
        normals: surfels.par_iter().map(|surfel| surfel.1).collect(),
        radii: vec![(OVERLAP * (area() / f64::from(points)).sqrt()) as f32; points as usize],
        colours: Some(Colours::Srgb8(surfels.par_iter().map(|surfel| surfel.2).collect())),
        ..Default::default()
    }
}

/// Direction of point `i`. Every point takes its own two numbers of the generator's sequence, so points can be computed
/// in any order.
fn jittered(i: u32, points: u32, mut rng: Pcg64) -> DVec3 {
    rng.advance(2 * u128::from(i));
    let mut quarter = || (rng.next_u64() >> 11) as f64 / (1u64 << 53) as f64 * 0.5 - 0.25;
    let (i, points) = (f64::from(i) + 0.5, f64::from(points));
    let spacing = (4.0 * PI / points).sqrt();
    let theta = (1.0 - 2.0 * i / points).acos() + quarter() * spacing;
    let theta = theta.clamp(1e-4, PI - 1e-4);
    let phi = (PI * (1.0 + 5f64.sqrt()) * i) % TAU + quarter() * spacing / theta.sin().max(1e-3);
    direction(theta, phi)
}

fn direction(theta: f64, phi: f64) -> DVec3 {
    DVec3::new(theta.sin() * phi.cos(), theta.cos(), theta.sin() * phi.sin())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shape_is_what_the_angles_say() {
        for i in 1..200 {
            let (theta, phi) = (f64::from(i) * PI / 200.0, f64::from(i) * 0.7);
            let expected = 1.0 + 0.1 * (5.0 * theta).sin() * (5.0 * phi).sin();
            assert!((shape(direction(theta, phi)).radius - expected).abs() < 1e-14);
            assert!((LEAST..=GREATEST).contains(&expected));
        }
    }

    #[test]
    fn gradients_agree_with_differences() {
        let step = 1e-6;
        for (i, p) in sample(500, 7).positions.iter().enumerate() {
            let p = p.as_dvec3() * (0.8 + 0.001 * i as f64);
            let across =
                |axis: DVec3| (implicit(p + step * axis).0 - implicit(p - step * axis).0) / (2.0 * step);
            let gradient = DVec3::new(across(DVec3::X), across(DVec3::Y), across(DVec3::Z));
            // Near the poles the curvature, and so the error of the difference, grows without bound.
            let tolerance = 1e-8 / p.x.hypot(p.z).powi(2).min(1.0);
            assert!(implicit(p).1.abs_diff_eq(gradient, tolerance), "{p}");
        }
    }

    #[test]
    fn samples_lie_on_the_surface_with_its_normals_and_fill_it_evenly() {
        let surfels = sample(20_000, 1);
        for (p, n) in surfels.positions.iter().zip(&surfels.normals) {
            let (value, gradient) = implicit(p.as_dvec3());
            assert!(value.abs() < 1e-6, "{p}");
            // Near the poles the normal changes within the rounding of the position.
            let tolerance = 1e-5 / f64::from(p.x.hypot(p.z));
            assert!(gradient.normalize().abs_diff_eq(n.as_dvec3(), tolerance), "{p}");
        }
        let mean: DVec3 = surfels.positions.iter().map(|p| p.as_dvec3()).sum::<DVec3>() / 20_000.0;
        assert!(mean.length() < 5e-3, "{mean}");
        let radius = 1.5 * (14.076f64 / 20_000.0).sqrt();
        assert!(surfels.radii.iter().all(|r| (f64::from(*r) - radius).abs() < 1e-6));
    }

    #[test]
    fn the_area_is_that_of_the_comparison_script() {
        assert!((area() - 14.076).abs() < 5e-4, "{}", area());
    }

    #[test]
    fn seeds_differ_and_repeat() {
        assert_eq!(sample(100, 3), sample(100, 3));
        assert_ne!(sample(100, 3).positions, sample(100, 4).positions);
    }

    #[test]
    fn every_point_is_moved_by_its_own_fraction_of_the_spacing() {
        let (rng, points) = (Pcg64::seed_from_u64(1), 10_000);
        let offset = |i: u32| {
            let lattice = (1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(points)).acos();
            (jittered(i, points, rng.clone()).y.acos() - lattice) / (4.0 * PI / f64::from(points)).sqrt()
        };
        let offsets: Vec<f64> = (100..points - 100).map(offset).collect();
        let mean = offsets.iter().sum::<f64>() / offsets.len() as f64;
        let variance = offsets.iter().map(|o| (o - mean).powi(2)).sum::<f64>() / offsets.len() as f64;
        // Uniform between −¼ and ¼.
        assert!(mean.abs() < 0.01 && (variance - 1.0 / 48.0).abs() < 1e-3, "{mean} {variance}");
        assert!(offsets.iter().all(|offset| offset.abs() < 0.2501));
    }

    #[test]
    fn colours_alternate() {
        let at =
            |theta: f64, phi: f64| colour(direction((theta + 0.5) * PI / 16.0, (phi + 0.5) * TAU / 32.0));
        assert_eq!(
            [at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0)],
            [[240, 235, 220], [230, 60, 40], [240, 235, 220]]
        );
        assert_eq!(at(15.0, 31.0), [240, 235, 220]);
        assert_eq!(at(3.0, 31.0), at(4.0, 0.0));
    }
}
