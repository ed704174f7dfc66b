//! Pass `pull`: merges finer samples in front into a coarser one (marroquim2008 section 3.2; with a perspective
//! ellipse, and exact displacements).

use super::camera_rays::CameraRays;
use super::{Decisions, Level, LevelDecisions, PassProgress, Sample, centre, facing_distance};
use glam::{DVec2, DVec3};

pub fn pass(rays: &CameraRays, finer: &Level, progress: &PassProgress<'_>) -> LevelDecisions {
    let level = finer.level + 1;
    LevelDecisions::new(level, finer.coarser_size(), progress, |at, decisions| {
        let own = centre(level, at);
        let covers = |sample: &Sample, disc: DVec2| decisions.covers(rays.radii2(sample, disc, own, 0.0));
        mean_of_front(own, &children(finer, at, covers), decisions)
    })
}

/// The finer samples of a pixel whose discs cover its centre, without the far side, with the centres of the discs.
pub fn children(
    finer: &Level,
    [x, y]: [i64; 2],
    covers: impl Fn(&Sample, DVec2) -> bool,
) -> Vec<(Sample, DVec2)> {
    let corners = [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[dx, dy]| [2 * x + dx, 2 * y + dy]);
    let discs = corners.into_iter().filter_map(|at| {
        let sample = finer.at(at)?;
        Some((sample, finer.centre(at) + sample.displacement))
    });
    let mut discs: Vec<_> = discs.filter(|(sample, disc)| covers(sample, *disc)).collect();
    let facing = facing_distance(discs.iter().map(|(sample, _)| sample));
    discs.retain(|(sample, _)| !sample.is_far_side(facing));
    discs
}

/// The mean of the discs that belong to the nearest surface and are of its kind, tube or not, for the pixel with centre
/// `own`. Its id is that of the disc whose centre is nearest to the pixel's.
pub fn mean_of_front(own: DVec2, discs: &[(Sample, DVec2)], decisions: &Decisions) -> Option<Sample> {
    let (front, _) = discs.iter().min_by(|a, b| a.0.near.total_cmp(&b.0.near))?;
    let one = |sample: &Sample| sample.near <= front.far && sample.tube == front.tube;
    let discs: Vec<_> = discs.iter().filter(|(sample, _)| one(sample)).collect();
    let shown = decisions.least(&discs, |(_, disc)| disc.distance_squared(own), |a, b| a.0.id == b.0.id)?;
    let count = discs.len() as f64;
    let mean = |of: &dyn Fn(&Sample) -> f64| discs.iter().map(|(sample, _)| of(sample)).sum::<f64>() / count;
    let mean3 =
        |of: &dyn Fn(&Sample) -> DVec3| discs.iter().map(|(sample, _)| of(sample)).sum::<DVec3>() / count;
    Some(Sample {
        near: discs.iter().map(|(sample, _)| sample.near).fold(f64::INFINITY, f64::min),
        far: discs.iter().map(|(sample, _)| sample.far).fold(0.0, f64::max),
        depth: mean(&|sample| sample.depth),
        displacement: discs.iter().map(|(_, disc)| *disc - own).sum::<DVec2>() / count,
        radius: mean(&|sample| sample.radius),
        normal: mean3(&|sample| sample.aligned_direction(front)).normalize_or_zero(),
        tube: front.tube,
        subpixel: front.subpixel,
        back: front.back,
        colour: mean3(&|sample| sample.colour),
        coordinates: front.coordinates
            + mean3(&|sample| sample.coordinate_offset(front).extend(0.0)).truncate(),
        id: discs[shown].0.id,
    })
}
