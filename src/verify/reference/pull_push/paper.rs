//! Passes `pull` and `push` as published (marroquim2008 sections 3.2 and 3.3).

use super::camera_rays::{CameraRays, Radii2};
use super::decisions::Decisions;
use super::pull::{children, mean_of_front};
use super::push::nearest_four;
use super::{Level, LevelDecisions, PassProgress, Sample, centre};
use crate::settings::pull_push::Weights;
use glam::{DVec2, DVec3};

/// Least minor semi-axis of an ellipse, px.
const LEAST_AXIS: f64 = 0.5;

/// Negated `ln` of the weight at the rim: σ is half the radius.
const RIM: f64 = 2.0;

/// Squared distance of `at` from the centre of a disc's ellipse by parallel projection, in squared radii.
pub fn radii2(rays: &CameraRays, sample: &Sample, disc: DVec2, at: DVec2) -> Radii2 {
    let e = at - disc;
    let normal = rays.normal(sample, disc);
    let along = normal.truncate().normalize_or(DVec2::X);
    let minor = (sample.radius * normal.z.abs()).max(LEAST_AXIS);
    let major = sample.radius.max(LEAST_AXIS);
    let value = (e.dot(along) / minor).powi(2) + (e.perp_dot(along) / major).powi(2);
    Radii2 { value, summands: value }
}

/// Fine to coarse.
pub fn pull(rays: &CameraRays, finer: &Level, progress: &PassProgress<'_>) -> LevelDecisions {
    let level = finer.level + 1;
    LevelDecisions::new(level, finer.coarser_size(), progress, |at, decisions| {
        let own = centre(level, at);
        let covers = |sample: &Sample, disc: DVec2| decisions.covers(radii2(rays, sample, disc, own));
        mean_of_front(own, &children(finer, at, covers), decisions)
    })
}

/// Coarse to fine: replaces a pixel that is empty or lies behind the coarser surface.
pub fn push(
    rays: &CameraRays,
    weights: Weights,
    coarser: &Level,
    pulled: &Level,
    progress: &PassProgress<'_>,
) -> LevelDecisions {
    LevelDecisions::new(pulled.level, pulled.size, progress, |at, decisions| {
        let own = centre(pulled.level, at);
        let around = nearest_four(at);
        let point = pulled.at(at);
        let behind = |point: &Sample| coarser.at(around[0]).is_some_and(|surface| point.near > surface.far);
        match point {
            Some(point) if !behind(&point) => Some(point),
            _ => {
                let discs = around.map(|at| Some((coarser.at(at)?, coarser.centre(at))));
                blend(rays, weights, own, decisions, &discs)
            }
        }
    })
}

/// The mean of covering discs of one kind: that of the greatest Gaussian weight, as the paper does not define a mix of tangents
/// and normals.
fn blend(
    rays: &CameraRays,
    weights: Weights,
    own: DVec2,
    decisions: &Decisions,
    coarser: &[Option<(Sample, DVec2)>],
) -> Option<Sample> {
    let weighted = coarser.iter().flatten().filter_map(|(sample, centre)| {
        let disc = *centre + sample.displacement;
        let radii2 = radii2(rays, sample, disc, own);
        let weight = match weights {
            Weights::Gaussian => (-RIM * radii2.value).exp(),
            Weights::Box => 1.0,
        };
        decisions.covers(radii2).then_some((sample, disc, weight, radii2.value))
    });
    let mut discs: Vec<_> = weighted.collect();
    let least = decisions.least(&discs, |disc| disc.3, |a, b| (a.0.id, a.0.tube) == (b.0.id, b.0.tube))?;
    let first = discs[least].0;
    discs.retain(|(sample, ..)| sample.tube == first.tube);
    let total: f64 = discs.iter().map(|(_, _, weight, _)| weight).sum();
    let mean = |of: &dyn Fn(&Sample) -> f64| discs.iter().map(|(s, _, w, _)| w * of(s)).sum::<f64>() / total;
    let mean3 =
        |of: &dyn Fn(&Sample) -> DVec3| discs.iter().map(|(s, _, w, _)| *w * of(s)).sum::<DVec3>() / total;
    (total > 0.0).then(|| Sample {
        near: mean(&|sample| sample.near),
        far: mean(&|sample| sample.far),
        depth: mean(&|sample| sample.depth),
        displacement: discs.iter().map(|(_, disc, w, _)| *w * (*disc - own)).sum::<DVec2>() / total,
        radius: mean(&|sample| sample.radius),
        normal: mean3(&|sample| sample.aligned_direction(first)).normalize_or_zero(),
        tube: first.tube,
        subpixel: first.subpixel,
        back: first.back,
        colour: mean3(&|sample| sample.colour),
        coordinates: DVec2::ZERO,
        id: first.id,
    })
}
