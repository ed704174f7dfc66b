//! Surfels of hidden sheets.

use crate::geometry::{Camera, Surfels};
use crate::verify::truth::Traceable;
use glam::DVec3;
use rayon::prelude::*;

/// Least distance of a hiding sheet in front of a surfel, in its radii: more than the rounding of its position.
const CLEARANCE: f64 = 0.01;
/// Distance behind a hit from which the next hit is searched, in distances of the surfel.
const STEP: f64 = 1e-6;
/// Most sheets along a ray.
const MOST_SHEETS: usize = 64;

/// The surfels whose sheet is the first one that the ray from a perspective camera to their centre meets. A surfel's
/// sheet is the nearest one along that ray, because noise or an inexact scan may move surfels off their sheet.
pub fn visible_surfels(surfels: &Surfels, surface: &dyn Traceable, camera: &Camera) -> Surfels {
    let eye = camera.view.inverse().w_axis.truncate();
    let is_visible = |&i: &u32| is_visible(surfels, i as usize, surface, eye);
    let visible: Vec<u32> = (0..surfels.len() as u32).into_par_iter().filter(is_visible).collect();
    let mut kept = surfels.clone();
    kept.permute(&visible);
    kept
}

fn is_visible(surfels: &Surfels, i: usize, surface: &dyn Traceable, eye: DVec3) -> bool {
    let to = surfels.origin + surfels.positions[i].as_dvec3() - eye;
    let clearance = CLEARANCE * f64::from(surfels.radii[i]) / to.length();
    let Some(first) = surface.trace(eye, to).map(|hit| hit.t) else { return true };
    if first > 1.0 - clearance {
        return true;
    }
    // The surfel is hidden if a further sheet is nearer to it than the first one.
    let mut t = first;
    for _ in 0..MOST_SHEETS {
        let from = t + STEP;
        match surface.trace(eye + from * to, to).map(|hit| from + hit.t) {
            Some(next) if (next - 1.0).abs() < (first - 1.0).abs() => return false,
            Some(next) if next < 1.0 => t = next,
            _ => return true,
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::subject::Subject;
    use crate::geometry::Colours;
    use crate::verify::scenes;

    #[test]
    fn of_a_sphere_the_cap_towards_the_eye_is_visible() {
        let name = "scene:sphere?points=5000";
        let surfels = scenes::open(name).unwrap();
        let subject = Subject::scene("scene:sphere").unwrap();
        let eye = DVec3::new(0.0, 0.0, 4.0);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.7, 1.0, 0.1).unwrap();
        let visible = visible_surfels(&surfels, subject.surface().unwrap(), &camera);
        // The horizon is where the eye's rays touch: z = 1 / 4.
        let in_front = surfels.positions.iter().filter(|p| p.z > 0.25).count();
        assert!(visible.len().abs_diff(in_front) < surfels.len() / 500, "{} {in_front}", visible.len());
        assert!(visible.positions.iter().all(|p| p.z > 0.2));
        // Noise does not change which surfels are visible.
        let noisy = scenes::open("scene:sphere?points=5000&noise=0.2").unwrap();
        let still_seen = visible_surfels(&noisy, subject.surface().unwrap(), &camera);
        // Noise moves some beyond the horizon into view.
        assert!(still_seen.len().abs_diff(in_front) < surfels.len() / 20, "{} {in_front}", still_seen.len());
        assert_eq!(visible.colours.as_ref().map(Colours::len), Some(visible.len()));
    }

    #[test]
    fn of_a_thin_slab_the_far_side_is_hidden() {
        let surfels = scenes::open("scene:slabs?slabs=1&thickness=0.001&points=30000").unwrap();
        let subject = Subject::scene("scene:slabs?slabs=1&thickness=0.001").unwrap();
        let eye = DVec3::new(0.1, 5.0, 0.1);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Z, 0.7, 1.0, 0.1).unwrap();
        let visible = visible_surfels(&surfels, subject.surface().unwrap(), &camera);
        let middle = subject.bounds().centre().y as f32;
        let upper = surfels.positions.iter().filter(|p| p.y > middle).count();
        assert!(visible.len().abs_diff(upper) < surfels.len() / 100, "{} {upper}", visible.len());
        assert!(visible.normals.iter().all(|n| n.y > -0.5));
    }
}
