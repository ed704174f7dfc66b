//! Pass `project`: the nearest point of each pixel (marroquim2008 section 3.1).

use super::super::scene::Counts;
use super::super::{Culled, Surfel};
use super::{Level, Reconstruction, Sample};
use crate::geometry::Surfels;
use crate::pull_push::Rules;
use crate::settings::Cull;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// The points that are seen, and what became of all.
#[derive(Clone, Debug, PartialEq)]
pub struct Visible {
    /// Level 0.
    pub level: Level,
    /// By pixel, the surfel's index.
    pub index: Vec<Option<usize>>,
    /// Of all surfels.
    pub counts: Counts,
}

/// A surfel's pixel and its sample there.
type Point = ([i64; 2], Sample);

pub fn pass(frame: &Reconstruction, surfels: &Surfels) -> Visible {
    let size = frame.projector.size.to_array().map(|side| side as u32);
    let point = |i: usize| match surfels.is_valid(i) {
        true => frame.point(&Surfel::of(surfels, i)),
        false => Err(Culled::Invalid),
    };
    let points: Vec<_> = (0..surfels.len()).into_par_iter().map(point).collect();
    let count = |cause: Culled| points.iter().filter(|p| p.as_ref().err() == Some(&cause)).count();
    let counts = Counts {
        surfels: points.len(),
        behind: count(Culled::Behind),
        eye_plane: 0,
        back: count(Culled::Back),
        outside: count(Culled::Outside),
        invalid: count(Culled::Invalid),
        drawn: points.iter().filter(|p| p.is_ok()).count(),
    };

    let mut index: Vec<Option<usize>> = vec![None; (size[0] * size[1]) as usize];
    let mut samples = vec![None; index.len()];
    for (i, ([x, y], sample)) in points.into_iter().enumerate().filter_map(|(i, p)| Some((i, p.ok()?))) {
        let pixel = (y * i64::from(size[0]) + x) as usize;
        // In their order: of two that are as near, the first stays.
        if samples[pixel].is_none_or(|there: Sample| sample.near < there.near) {
            (samples[pixel], index[pixel]) = (Some(sample), Some(i));
        }
    }
    Visible { level: Level { level: 0, size, samples }, index, counts }
}

impl Reconstruction {
    fn point(&self, surfel: &Surfel) -> Result<Point, Culled> {
        let projector = &self.projector;
        let at = projector.view.transform_point3(surfel.position);
        let normal = projector.view.transform_vector3(surfel.normal);
        let distance = projector.distance(at);
        let [near, far] = projector.planes();
        if !(near..=far).contains(&distance) {
            return Err(Culled::Behind);
        }
        let towards = projector.facing(at, normal);
        let back = projector.settings.cull == Cull::Back && !surfel.two_sided;
        if towards >= 0.0 && back || towards == 0.0 {
            return Err(Culled::Back);
        }
        // Seen from behind, a disc is that of the opposite normal.
        let normal = if towards > 0.0 { -normal } else { normal };
        let homogeneous = projector.homogeneous_pixel(at.extend(1.0));
        let pixel = homogeneous.truncate() / homogeneous.z;
        let corner = pixel.floor();
        if corner.cmplt(DVec2::ZERO).any() || corner.cmpge(projector.size).any() {
            return Err(Culled::Outside);
        }
        let coordinates = [corner.x as i64, corner.y as i64];
        // A disc of the ellipse's area.
        let radius = surfel.radius * surfel.aspect.sqrt();
        let [thickness, displacement] = match self.pull_push.rules {
            Rules::Paper => [1.0, 0.0],
            // Twice the radius: half as much takes neighbours of a steep surface for another.
            Rules::Robust => [2.0, 1.0],
        };
        let sample = Sample {
            near: distance,
            far: distance + thickness * radius,
            depth: distance,
            displacement: displacement * (pixel - corner - 0.5),
            radius: self.lens.to_pixels(radius, distance),
            normal,
            colour: surfel
                .colour
                .unwrap_or(DVec3::from_array(projector.settings.lighting.albedo.map(f64::from))),
        };
        Ok((coordinates, sample))
    }
}
