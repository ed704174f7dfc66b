//! Passes `pull` and `push` as the paper has them (marroquim2008 sections 3.2 and 3.3).

use super::lens::{Lens, Radii2};
use super::margin::Margin;
use super::pull::{children, mean_of_front};
use super::push::nearest_four;
use super::{Decided, Level, Sample, Watch, centre};
use glam::{DVec2, DVec3};

/// Least minor semi-axis of an ellipse, px.
const LEAST_AXIS: f64 = 0.5;

/// `ln` of the weight at the rim, negated: σ is half of the radius.
const RIM: f64 = 2.0;

/// Squared distance of `at` from the centre of a disc's ellipse by parallel projection, in its radii.
pub fn radii2(lens: &Lens, sample: &Sample, disc: DVec2, at: DVec2) -> Radii2 {
    let e = at - disc;
    let normal = lens.normal(sample, disc);
    let along = normal.truncate().normalize_or(DVec2::X);
    let minor = (sample.radius * normal.z.abs()).max(LEAST_AXIS);
    let major = sample.radius.max(LEAST_AXIS);
    let value = (e.dot(along) / minor).powi(2) + (e.perp_dot(along) / major).powi(2);
    Radii2 { value, summands: value }
}

/// Fine to coarse.
pub fn pull(lens: &Lens, finer: &Level, watch: &Watch<'_>) -> Decided {
    let level = finer.level + 1;
    Decided::new(level, finer.coarser_size(), watch, |at, margin| {
        let own = centre(level, at);
        let covers = |sample: &Sample, disc: DVec2| margin.covers(radii2(lens, sample, disc, own));
        mean_of_front(own, &children(finer, at, covers), margin)
    })
}

/// Coarse to fine: a pixel that is empty, or behind what the coarser one has, is made anew.
pub fn push(lens: &Lens, coarser: &Level, pulled: &Level, watch: &Watch<'_>) -> Decided {
    Decided::new(pulled.level, pulled.size, watch, |at, margin| {
        let own = centre(pulled.level, at);
        let around = nearest_four(at);
        let point = pulled.at(at);
        let behind = |point: &Sample| coarser.at(around[0]).is_some_and(|surface| point.near > surface.far);
        match point {
            Some(point) if !behind(&point) => Some(point),
            _ => blend(lens, own, margin, &around.map(|at| Some((coarser.at(at)?, coarser.centre(at))))),
        }
    })
}

/// Its kind is that of the greatest weight; how tangents and normals would mix is not said.
fn blend(lens: &Lens, own: DVec2, margin: &Margin, coarser: &[Option<(Sample, DVec2)>]) -> Option<Sample> {
    let weighted = coarser.iter().flatten().filter_map(|(sample, centre)| {
        let disc = *centre + sample.displacement;
        let radii2 = radii2(lens, sample, disc, own);
        margin.covers(radii2).then(|| (sample, disc, (-RIM * radii2.value).exp(), radii2.value))
    });
    let mut discs: Vec<_> = weighted.collect();
    let least = margin.least(&discs, |disc| disc.3, |a, b| (a.0.id, a.0.tube) == (b.0.id, b.0.tube))?;
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
        normal: mean3(&|sample| sample.direction_as(first)).normalize_or_zero(),
        tube: first.tube,
        colour: mean3(&|sample| sample.colour),
        coordinates: DVec2::ZERO,
        id: first.id,
    })
}
