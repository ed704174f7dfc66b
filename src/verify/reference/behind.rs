//! Pass `behind`: mixes the surface behind into pixels whose nearest surface leaves some samples to other splats.

use super::bands::Band;
use super::coverage::{self, Mask, mask, solid};
use super::ellipse::Ellipse;
use super::normalize::{Value, resolve};
use super::projected_scene::ProjectedScene;
use super::rank::Rank;
use super::visibility::occlusion_depth;
use super::{Projector, attribute};

/// The values of the band's pixels, from those of the nearest surface up to the depths `visible`, with covered fractions `alpha`.
pub(super) fn pass(
    projector: &Projector,
    scene: &ProjectedScene,
    band: &Band,
    visible: &[Rank],
    alpha: &[f64],
    values: Vec<Value>,
) -> Vec<Value> {
    let nearest = coverage::masks(projector, scene, band, |pixel, rank| rank.is_within(visible[pixel]));
    let depth = visibility(projector, scene, band, visible, &nearest);
    let sums = attribute::pass(projector, scene, band, |pixel, rank| {
        rank > visible[pixel] && rank.is_within(depth[pixel])
    });
    let pixel = |(i, value): (usize, Value)| {
        let behind = resolve(projector, band.centre(i), depth[i].exists().then_some(&sums[i]), alpha[i]);
        mixed(value, &behind, coverage::part(nearest[i]) / alpha[i])
    };
    values.into_iter().enumerate().map(pixel).collect()
}

/// For every pixel: the least depth of the splats behind the nearest surface that cover samples which it leaves free, each moved back by its ε.
fn visibility(
    projector: &Projector,
    scene: &ProjectedScene,
    band: &Band,
    visible: &[Rank],
    nearest: &[Mask],
) -> Vec<Rank> {
    let mut behind = vec![Rank::NONE; band.len()];
    for splat in band.occluders(scene).iter() {
        let (seen, solid) = (Ellipse::visibility(splat, projector), solid(splat, projector));
        band.inside(&seen, |hit| {
            let i = hit.index;
            let Some(depth) = projector.depth_of(splat, hit.at) else { return };
            let is_behind = visible[i].exists() && hit.rank(depth) > visible[i];
            if is_behind && nearest[i] != Mask::MAX && mask(&solid, hit.offset) & !nearest[i] != 0 {
                behind[i] = behind[i].min(hit.rank(occlusion_depth(projector, splat, depth)));
            }
        });
    }
    behind
}

/// The value of a pixel whose nearest surface has this share of the covered samples; `behind` is that of the other ones.
pub(super) fn mixed(nearest: Value, behind: &Value, share: f64) -> Value {
    if !(nearest.covered && behind.covered) {
        return nearest;
    }
    let mut colour = nearest.colour;
    for (channel, of_behind) in colour.iter_mut().zip(behind.colour) {
        *channel = share * *channel + (1.0 - share) * of_behind;
    }
    Value { colour, ..nearest }
}
