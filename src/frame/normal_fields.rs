//! Whether a frame sums normal fields: these are 0 in splats of few pixels, so a frame of such splats alone needs none.

use crate::geometry::Camera;
use crate::scene::instance::Placed;
use crate::settings::Settings;
use glam::{DVec2, DVec3};

/// How far beyond the edges of the picture discs with fragments are, px: larger ones have fields anyway.
const BEYOND: f64 = 8.0;

/// Whether a normal field of these scenes may differ from 0 in a picture of `size` px.
pub fn may_bend(scenes: &[Placed<'_>], camera: &Camera, settings: &Settings, size: [u32; 2]) -> bool {
    // Of the rim, px.
    let flat = f64::from(settings.cutoff) * settings.flat_variance().sqrt();
    scenes.iter().any(|placed| {
        let radius = placed.largest_curved();
        let scale = || {
            let bounds = placed.curved_bounds();
            bounds.map_or(f64::INFINITY, |bounds| most_scale(camera, size, (bounds.centre(), bounds.radius)))
        };
        radius > 0.0 && radius * scale() > flat
    })
}

/// Largest ratio of lengths in the picture, px, to those in a sphere: the largest singular value of the projection's Jacobian, which grows towards
/// the corners of the picture and towards the eye. Infinite if the sphere reaches the eye plane.
fn most_scale(camera: &Camera, size: [u32; 2], (centre, radius): (DVec3, f64)) -> f64 {
    let clip = camera.world_to_clip();
    let [x, y, w] = [0, 1, 3].map(|row| clip.row(row));
    let nearest = w.dot(centre.extend(1.0)).abs() - w.truncate().length() * radius;
    if nearest <= 0.0 || nearest.is_nan() {
        return f64::INFINITY;
    }
    let half = 0.5 * DVec2::from(size.map(f64::from));
    let edge = 1.0 + BEYOND / half;
    let at_corner = |[right, up]: [f64; 2]| {
        let x = half.x * (x - right * edge.x * w).truncate();
        let y = half.y * (y - up * edge.y * w).truncate();
        let (mean, difference) = (0.5 * (x.dot(x) + y.dot(y)), 0.5 * (x.dot(x) - y.dot(y)));
        (mean + difference.hypot(x.dot(y))).sqrt()
    };
    let corners = [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]];
    corners.into_iter().map(at_corner).fold(0.0, f64::max) / nearest
}

#[cfg(all(test, feature = "reference"))]
mod tests {
    use super::*;
    use crate::geometry::Surfels;
    use crate::verify::reference::{Surfel, footprint};
    use glam::DVec4;

    /// A number from −1 to 1.
    fn random(state: &mut u64) -> f64 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (*state >> 11) as f64 / 2f64.powi(52) - 1.0
    }

    #[test]
    fn no_disc_is_larger_than_its_bound() {
        let mut off_centre = Camera::look_at(DVec3::ZERO, DVec3::Z, DVec3::NEG_Y, 1.4, 0.5, 0.01).unwrap();
        off_centre.projection.z_axis += DVec4::new(0.3, -0.2, 0.0, 0.0);
        let parallel =
            Camera::orthographic([DVec3::ZERO, DVec3::Z, DVec3::NEG_Y], 4.0, 0.5, [0.1, 100.0]).unwrap();
        let (size, settings) = ([60, 120], Settings { cutoff: 2.0, ..Settings::default() });
        let (mut state, mut drawn, mut largest) = (1, 0, 0f64);
        for i in 0..20_000 {
            let camera = [off_centre, parallel][i % 2];
            let mut vector = || DVec3::new(random(&mut state), random(&mut state), random(&mut state));
            let (position, normal) =
                (DVec3::new(2.0, 2.0, 2.0) * vector() + 3.0 * DVec3::Z, vector().normalize());
            let radius = 0.03 * (1.1 + random(&mut state));
            let (positions, normals) = (vec![position.as_vec3()], vec![normal.as_vec3()]);
            let surfels = Surfels { positions, normals, radii: vec![radius as f32], ..Surfels::default() };
            let surfel = Surfel::of(&surfels, 0);
            let Ok(splat) = footprint(&surfel, &camera, size, &settings).unwrap() else { continue };
            let scale = most_scale(&camera, size, (surfel.position, surfel.radius));
            let [xx, xy, yy] = [splat.variance.x_axis.x, splat.variance.x_axis.y, splat.variance.y_axis.y];
            let sigma = (0.5 * (xx + yy + (xx - yy).hypot(2.0 * xy))).sqrt();
            let ratio = 2.0 * sigma / (scale * surfel.radius);
            assert!(ratio <= 1.0 + 1e-9, "{surfel:?}: {ratio} of the bound");
            (drawn, largest) = (drawn + 1, largest.max(ratio));
        }
        assert!(drawn > 1000 && largest > 0.9, "{drawn} discs, of {largest} of the bound");
    }
}
