//! A first impression of everything.

use super::{Suite, aliasing, baseline, lowpass, methods, plan};
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::settings::methods::pull_push;
use crate::verify::baseline::Kind;

const SIZE: [u32; 2] = [320, 320];
/// Where every method is measured: more runs of them would take more than a minute.
const EVERY_METHOD: (&str, u64) = ("scene:bumpy-sphere", 100_000);

pub(super) fn plans() -> Vec<Plan> {
    let mut plans = Vec::new();
    for scene in ["scene:bumpy-sphere", "scene:torus", "scene:part"] {
        for points in [10_000, 100_000, 1_000_000] {
            plans.extend(budget(scene, points));
            let smooth = plan(Suite::Quick, Experiment::Budget, scene, points, SIZE);
            if (scene, points) == EVERY_METHOD {
                plans.extend(methods(&smooth))
            } else {
                plans.push(smooth.by(&pull_push::METHOD))
            }
        }
    }
    plans.extend(lowpass(Suite::Quick, "scene:bumpy-sphere", 100_000, SIZE, &[0.0, 0.5, 1.0], &[1.5, 2.5]));
    plans.extend(aliasing(Suite::Quick, [256, 256]));
    plans
}

/// Sharp and smooth; with the parts of the error where the float64 reference is fast.
fn budget(scene: &str, points: u64) -> Vec<Plan> {
    let smooth = plan(Suite::Quick, Experiment::Budget, scene, points, SIZE);
    let mut sharp = smooth.clone();
    sharp.settings.lowpass = 0.0;
    let middle = points == 100_000;
    let few = points < 1_000_000;
    let measurements = Measurements { terms: few, float64_error: few, images: middle, ..Measurements::BOTH };
    vec![
        Plan { measurements, ..smooth.clone() },
        sharp,
        baseline(&smooth, Kind::Splats),
        baseline(&smooth, Kind::Pixels),
    ]
}
