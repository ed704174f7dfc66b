//! Pass `attribute`: weighted sums of the splats that the visibility depth lets through (zwicker2004 equation 2).

use super::bands::Band;
use super::ellipse::Ellipse;
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::{Projector, Splat};
use crate::settings::Shading;
use glam::DVec3;

/// Sums of one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sums {
    /// `Σ w`.
    pub weight: f64,
    /// `Σ w n`.
    pub normal: DVec3,
    /// `Σ w rgb`.
    pub colour: DVec3,
    /// `Σ w / z` in perspective, `Σ w z` in orthographic projection.
    pub depth: f64,
}

impl Sums {
    /// Contribution of `splat` with its normal at the pixel, with weight `weight` at distance `depth`. With [`Shading::Overlap`] every weight
    /// is 1.
    pub fn of(projector: &Projector, splat: &Splat, normal: DVec3, weight: f64, depth: f64) -> Self {
        let weight = if projector.settings.shading == Shading::Overlap { 1.0 } else { weight };
        Self {
            weight,
            normal: weight * normal,
            colour: weight * splat.colour,
            depth: if projector.depth.perspective { weight / depth } else { weight * depth },
        }
    }
}

impl std::ops::AddAssign for Sums {
    fn add_assign(&mut self, other: Self) {
        self.weight += other.weight;
        self.normal += other.normal;
        self.colour += other.colour;
        self.depth += other.depth;
    }
}

/// Sums every pixel of the band over the fragments of these ranks at a pixel.
pub(super) fn pass(
    projector: &Projector,
    scene: &ProjectedScene,
    band: &Band,
    counts: impl Fn(usize, Rank) -> bool,
) -> Vec<Sums> {
    let mut sums = vec![Sums::default(); band.len()];
    for splat in band.contributors(scene).iter() {
        let ellipse = Ellipse::attribute(splat, projector);
        band.inside(&ellipse, |hit| {
            let Some(depth) = projector.depth_of(splat, hit.at) else { return };
            if counts(hit.index, hit.rank(depth)) {
                let (normal, weight) = (ellipse.normal(hit.offset), ellipse.weight(hit.in_kernel));
                sums[hit.index] += Sums::of(projector, splat, normal, weight, depth);
            }
        });
    }
    sums
}
