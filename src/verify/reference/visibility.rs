//! Pass `visibility`: the depth up to which splats are blended (zwicker2004 section 6, first pass).

use super::bands::Band;
use super::ellipse::Ellipse;
use super::nearest::ranked;
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::{Projector, Splat};

/// For every pixel of the band: the least depth of its splats, each moved back by its ε along the viewing ray.
pub(super) fn pass(projector: &Projector, scene: &ProjectedScene, band: &Band) -> Vec<Rank> {
    let mut nearest = vec![Rank::NONE; band.len()];
    for splat in band.occluders(scene).iter() {
        let ellipse = Ellipse::visibility(splat, projector);
        band.inside(&ellipse, |hit| {
            if let Some(depth) = projector.depth_of(splat, hit.at) {
                nearest[hit.index] =
                    nearest[hit.index].min(hit.rank(occlusion_depth(projector, splat, depth)));
            }
        });
    }
    nearest
}

/// The depth behind which a fragment at `depth` hides everything: its own plus ε. May lie beyond the far plane, as it
/// is a bound and not a surface.
///
/// It is never nearer than the disc's nearest point plus ε. The low-pass filter widens a disc seen edge-on by most of a
/// pixel, over which its plane extends far in front of the disc.
pub(super) fn occlusion_depth(projector: &Projector, splat: &Splat, depth: f64) -> f64 {
    let depth = ranked(splat, depth);
    if projector.depth.perspective { depth * splat.shift } else { depth + splat.shift }
}
