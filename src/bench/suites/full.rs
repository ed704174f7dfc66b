//! Every scene, at every density.

use super::{Suite, aliasing, baseline, lowpass, methods, plan};
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::verify::baseline::Kind;
use crate::verify::scenes;

const SIZE: [u32; 2] = [512, 512];
const POINTS: [u64; 5] = [10_000, 30_000, 100_000, 300_000, 1_000_000];

pub(super) fn plans() -> Vec<Plan> {
    let scenes = || scenes::list().iter().map(|scene| scene.name);
    let mut plans: Vec<_> =
        scenes().flat_map(|scene| POINTS.map(|points| budget(scene, points))).flatten().collect();
    let (variances, cutoffs) = ([0.0, 0.25, 0.5, 0.75, 1.0], [1.5, 2.0, 2.5, 3.0, 4.0]);
    for (scene, points) in
        [("scene:bumpy-sphere", 100_000), ("scene:bumpy-sphere", 1_000_000), ("scene:plane", 1_000_000)]
    {
        plans.extend(lowpass(Suite::Full, scene, points, SIZE, &variances, &cutoffs));
    }
    plans.extend(aliasing(Suite::Full, [256, 256]));
    plans
}

/// Smooth and sharp, every other method, and the CPU baseline.
fn budget(scene: &str, points: u64) -> Vec<Plan> {
    let smooth = plan(Suite::Full, Experiment::Budget, scene, points, SIZE);
    let mut sharp = smooth.clone();
    sharp.settings.lowpass = 0.0;
    let measurements = Measurements {
        terms: true,
        float64_error: points <= 100_000,
        images: points == 100_000,
        ..Measurements::BOTH
    };
    let plain = [Kind::Splats, Kind::Pixels].map(|kind| baseline(&smooth, kind));
    // Images of every method are shown for one scene only.
    let images = measurements.images && scene == "scene:bumpy-sphere";
    let others = methods(&smooth)
        .map(|plan| Plan { measurements: Measurements { images, ..Measurements::BOTH }, ..plan });
    let others: Vec<Plan> = others.collect();
    [Plan { measurements, ..smooth }, sharp].into_iter().chain(others).chain(plain).collect()
}
