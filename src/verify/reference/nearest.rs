//! Pass `nearest`: the nearest splat of each pixel, alone (zwicker2004 table 1; botsch2003 section 3.2).

use super::attribute::Sums;
use super::bands::Band;
use super::ellipse::Ellipse;
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::{Projector, Splat};

/// The sums of the nearest splat of each pixel of the band, with weight 1. The first of equally near splats wins.
pub(super) fn pass(projector: &Projector, scene: &ProjectedScene, band: &Band) -> Vec<Option<Sums>> {
    let mut nearest = vec![(Rank::NONE, None); band.len()];
    for splat in band.contributors(scene).iter() {
        let ellipse = Ellipse::visibility(splat, projector);
        band.inside(&ellipse, |hit| {
            let Some(depth) = projector.depth_of(splat, hit.at) else { return };
            let rank = hit.rank(ranked(splat, depth));
            if rank < nearest[hit.index].0 {
                nearest[hit.index] = (rank, Some(Sums::of(projector, splat, splat.normal, 1.0, depth)));
            }
        });
    }
    nearest.into_iter().map(|(_, sums)| sums).collect()
}

/// The depth by which splats are ranked: at least that of the disc's nearest point.
pub(super) fn ranked(splat: &Splat, depth: f64) -> f64 {
    depth.max(splat.nearest)
}
