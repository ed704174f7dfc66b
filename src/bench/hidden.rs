//! Surfels that the surface itself hides.

use crate::geometry::{Camera, Surfels};
use crate::truth::Scene;
use glam::DVec3;
use rayon::prelude::*;

/// How far in front of a surfel, in its radii, the surface must be to hide it: more than rounding its position has moved it, less than any
/// other sheet is off.
const CLEARANCE: f64 = 0.01;

/// The surfels whose centres a perspective camera sees.
pub fn without(surfels: &Surfels, surface: &dyn Scene, camera: &Camera) -> Surfels {
    let eye = camera.view.inverse().w_axis.truncate();
    let seen: Vec<u32> = (0..surfels.len() as u32)
        .into_par_iter()
        .filter(|&i| is_seen(surfels, i as usize, surface, eye))
        .collect();
    let mut kept = surfels.clone();
    kept.permute(&seen);
    kept
}

fn is_seen(surfels: &Surfels, i: usize, surface: &dyn Scene, eye: DVec3) -> bool {
    let to = surfels.origin + surfels.positions[i].as_dvec3() - eye;
    let clearance = CLEARANCE * f64::from(surfels.radii[i]) / to.length();
    surface.trace(eye, to).is_none_or(|hit| hit.t > 1.0 - clearance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::subject::Subject;
    use crate::geometry::Colours;
    use crate::scenes;

    #[test]
    fn of_a_sphere_the_cap_towards_the_eye_is_seen() {
        let name = "scene:sphere?points=20000";
        let surfels = scenes::open(name).unwrap();
        let subject = Subject::scene("scene:sphere").unwrap();
        let eye = DVec3::new(0.0, 0.0, 4.0);
        let camera = Camera::look_at(eye, DVec3::ZERO, DVec3::Y, 0.7, 1.0, 0.1).unwrap();
        let seen = without(&surfels, subject.surface(), &camera);
        // The horizon is where the eye's rays touch: z = 1 / 4.
        let in_front = surfels.positions.iter().filter(|p| p.z > 0.25).count();
        assert!(seen.len().abs_diff(in_front) < surfels.len() / 500, "{} {in_front}", seen.len());
        assert!(seen.positions.iter().all(|p| p.z > 0.2));
        assert_eq!(seen.colours.as_ref().map(Colours::len), Some(seen.len()));
    }
}
