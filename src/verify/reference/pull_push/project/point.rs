//! A surfel covers the one pixel that holds its centre.

use super::super::super::{Culled, Surfel};
use super::{Point, Reconstruction, Sample, Vertex};
use crate::settings::Cull;
use glam::DVec2;

/// Least radius of a point's disc, px: smaller ones would not cover their own pixel's centre.
const LEAST_RADIUS: f64 = 1.0;

impl Reconstruction {
    pub(super) fn point(&self, surfel: &Surfel) -> Result<Point, Culled> {
        let projector = &self.projector;
        let surfel = &projector.facing_eye(surfel);
        let position = projector.view.transform_point3(surfel.position);
        let normal = projector.view.transform_vector3(surfel.normal);
        let [near, far] = projector.planes();
        let distance = projector.distance(position);
        if !(near..=far).contains(&distance) || distance <= 0.0 {
            return Err(Culled::Behind);
        }
        let towards = projector.facing(position, normal);
        let back = projector.settings.cull == Cull::Back && !surfel.two_sided;
        if towards >= 0.0 && back {
            return Err(Culled::Back);
        }
        if towards == 0.0 {
            return Err(Culled::Outside);
        }
        let screen = self.pixel(position);
        let corner = screen.floor();
        if corner.cmplt(DVec2::ZERO).any() || corner.cmpge(projector.size).any() {
            return Err(Culled::Outside);
        }
        // A disc of the ellipse's area.
        let radius = surfel.radius * surfel.aspect.sqrt();
        let least = if self.is_paper() {
            0.0
        } else {
            self.rays.to_length(LEAST_RADIUS, self.projector.distance(position))
        };
        let disc = Vertex {
            position,
            // A disc seen from behind has the opposite normal.
            direction: if towards > 0.0 { -normal } else { normal },
            radius: radius.max(least),
            colour: surfel.colour.unwrap_or(self.albedo()),
            coordinates: DVec2::ZERO,
        };
        let at = [corner.x as i64, corner.y as i64];
        let back = projector.settings.finds_sides() && towards > 0.0 && !surfel.two_sided;
        Ok((at, Sample { subpixel: radius < least, back, ..self.sample(disc, screen, at, false) }))
    }
}
