//! Least work of the passes of a frame.

use super::record::PassWork;
use crate::frame::PassTraffic;
use crate::geometry::{Camera, Surfels};
use crate::settings::{Cull, Settings};
use rayon::prelude::*;

/// The work of passes with this traffic on a picture of `size` px with so many drawn surfels.
pub fn of(traffic: &[PassTraffic], drawn: u64, size: [u32; 2]) -> Vec<PassWork> {
    let (drawn, pixels) = (drawn as f64, f64::from(size[0]) * f64::from(size[1]));
    let one = |pass: &PassTraffic| PassWork {
        name: pass.name.into(),
        bytes: (pass.surfel * drawn + pass.pixel * pixels) as u64,
        pixels: (pass.written * pixels) as u64,
        atomics: (pass.atomics * drawn) as u64,
    };
    traffic.iter().map(one).collect()
}

/// Surfels that are certainly drawn: their centres are in the picture and, if back faces are culled, they face the eye.
pub fn drawn(surfels: &Surfels, camera: &Camera, settings: &Settings) -> u64 {
    let to_clip = camera.world_to_clip();
    // The eye, or of parallel rays a point at infinity towards it.
    let eye = camera.projection.inverse() * glam::DVec4::Z * if camera.reversed { 1.0 } else { -1.0 };
    let eye = camera.view.inverse() * eye;
    let is_drawn = |&i: &usize| {
        let position = surfels.origin + surfels.positions[i].as_dvec3();
        let clip = to_clip * position.extend(1.0);
        let is_inside = clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w;
        let to_eye = eye.truncate() - eye.w * position;
        let faces_eye = || surfels.is_billboard(i) || surfels.normals[i].as_dvec3().dot(to_eye) > 0.0;
        is_inside && (settings.cull == Cull::None || faces_eye())
    };
    (0..surfels.len()).into_par_iter().filter(is_drawn).count() as u64
}
