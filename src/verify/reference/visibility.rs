//! Pass `visibility`: the depth up to which splats are blended (zwicker2004 section 6, first pass).

use super::bands::Band;
use super::ellipse::Ellipse;
use super::nearest::ranked;
use super::rank::Rank;
use super::scene::Scene;
use super::{Projector, Splat};

/// For every pixel of the band the least depth of its splats, each moved back along the viewing ray by its ε.
pub(super) fn pass(projector: &Projector, scene: &Scene, band: &Band) -> Vec<Rank> {
    let mut nearest = vec![Rank::NONE; band.len()];
    for splat in band.blockers(scene).iter() {
        let ellipse = Ellipse::visibility(splat, projector);
        band.inside(&ellipse, |hit| {
            if let Some(depth) = projector.depth_of(splat, hit.at) {
                nearest[hit.index] = nearest[hit.index].min(hit.rank(claimed(projector, splat, depth)));
            }
        });
    }
    nearest
}

/// What a fragment at `depth` claims: that all is hidden from its ε behind it on. May lie beyond the far plane: it is a bound, not a
/// surface.
///
/// Nothing is claimed nearer than the disc itself. The low-pass widens a disc seen edge-on by most of a pixel, over which its plane
/// runs far out in front of it.
pub(super) fn claimed(projector: &Projector, splat: &Splat, depth: f64) -> f64 {
    let depth = ranked(splat, depth);
    if projector.depth.perspective { depth * splat.shift } else { depth + splat.shift }
}
