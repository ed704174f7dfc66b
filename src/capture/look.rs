//! One picture of Σw and depth, and what it says of the surfels.

use super::gather::Sample;
use crate::error::Result;
use crate::geometry::{Camera, Surfels};
use crate::picture::Picture;
use crate::reference::{Projector, Surfel};
use crate::renderer::Renderer;
use crate::scene::Scene;
use crate::settings::Settings;
use glam::{DVec2, DVec3};
use rayon::prelude::*;

/// Least cosine of the angle between ray and normal: seen from further aside, the surface hides parts of itself.
const LEAST_COSINE: f64 = 0.5;
/// Least extent of a disc from its centre, px: smaller ones are narrower than what lies between two pixels.
const LEAST_RADIUS: f64 = 2.0;
/// From one corner of a surfel's square to its centre the sum may change by this factor; beyond, each corner has a weight of its own.
const STEADY: f64 = 2.0;

/// A picture from somewhere.
pub(super) struct Look {
    projector: Projector,
    picture: Picture,
    epsilon: f64,
}

/// What is seen at a point of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Seen {
    /// The surface, with this Σw.
    Sum(f64),
    /// It has ended: nothing, or something behind.
    Gap,
    /// Something in front, or it is not in the picture.
    Hidden,
}

impl Look {
    /// Renders `scene` with settings that show Σw.
    pub fn new(renderer: &mut Renderer, scene: &Scene, camera: &Camera, settings: &Settings) -> Result<Self> {
        let (picture, _) = renderer.render_picture(scene, camera, settings)?;
        let projector = Projector::new(camera, picture.size, settings)?;
        Ok(Self { projector, picture, epsilon: settings.epsilon.into() })
    }

    /// What is seen of the surfels whose centres are visible. `surfels` are the scene's.
    pub fn samples(&self, surfels: &Surfels) -> Vec<Sample> {
        let sample = |i: usize| surfels.is_valid(i).then(|| self.sample(i, &Surfel::of(surfels, i)))?;
        (0..surfels.len()).into_par_iter().filter_map(sample).collect()
    }

    fn sample(&self, index: usize, surfel: &Surfel) -> Option<Sample> {
        let u = surfel.radius * surfel.major;
        let v = surfel.aspect * surfel.normal.cross(u);
        let (centre, distance) = self.projector.locate(surfel.position)?;
        let (_, step) = self.projector.ray(centre);
        if step.normalize().dot(surfel.normal).abs() < LEAST_COSINE {
            return None;
        }
        let tolerance = self.epsilon * surfel.radius;
        let Seen::Sum(sum) = self.at(centre, distance, tolerance) else { return None };
        let extent = |axis: DVec3| Some(self.projector.locate(surfel.position + axis)?.0.distance(centre));
        if extent(u)?.min(extent(v)?) < LEAST_RADIUS {
            return None;
        }
        let corner = |offset: DVec3| {
            let located = self.projector.locate(surfel.position + offset);
            located.map_or(Seen::Hidden, |(at, distance)| self.at(at, distance, tolerance))
        };
        let corners = [-u - v, u - v, v - u, u + v].map(corner);
        let is_border = corners.iter().any(|corner| match corner {
            Seen::Sum(other) => (other / sum).max(sum / other) > STEADY,
            Seen::Gap => true,
            Seen::Hidden => false,
        });
        let known = corners.map(|corner| match corner {
            Seen::Sum(sum) => Some(sum as f32),
            Seen::Gap => Some(0.0),
            Seen::Hidden => None,
        });
        Some(Sample { surfel: index as u32, sum: sum as f32, corners: is_border.then_some(known) })
    }

    /// What is seen of a point of a surface at a pixel position, px, and a distance, from which depths may differ by `tolerance`: Σw between
    /// the four pixels around it, or those of them that show the surface.
    fn at(&self, at: DVec2, distance: f64, tolerance: f64) -> Seen {
        let first = (at - 0.5).floor();
        let part = at - 0.5 - first;
        let (mut total, mut share, mut in_front) = (0.0, 0.0, false);
        for (x, y) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            let offset = DVec2::new(f64::from(x), f64::from(y));
            let Some((sum, depth)) = self.pixel(first + offset) else { return Seen::Hidden };
            in_front |= depth > 0.0 && depth < distance - tolerance;
            if depth > 0.0 && (depth - distance).abs() <= tolerance {
                let [near_x, near_y] = (1.0 - (offset - part).abs()).to_array();
                total += near_x * near_y * sum;
                share += near_x * near_y;
            }
        }
        match (share > 0.0 && total > 0.0, in_front) {
            (true, _) => Seen::Sum(total / share),
            (false, true) => Seen::Hidden,
            (false, false) => Seen::Gap,
        }
    }

    /// Σw and depth of a pixel; `None` beyond the picture.
    fn pixel(&self, at: DVec2) -> Option<(f64, f64)> {
        let size = DVec2::new(self.picture.size[0].into(), self.picture.size[1].into());
        let inside = at.cmpge(DVec2::ZERO).all() && at.cmplt(size).all();
        let index = inside.then_some(at.y as usize * self.picture.size[0] as usize + at.x as usize)?;
        let depth = self.picture.depth.as_ref()?[index];
        Some((self.picture.colour[index][0].into(), depth.into()))
    }
}
