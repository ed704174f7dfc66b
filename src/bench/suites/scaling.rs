//! Time against points, pixels and overlap, and time and error against the level of detail.

use super::{Suite, baseline, methods, plan};
use crate::bench::place::Place;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::settings::Settings;
use crate::settings::methods::{Method, confetti, perspective_ewa, pull_push};
use crate::verify::baseline::Kind;
use crate::verify::scenes::Viewpoint;

const SCENE: &str = "scene:bumpy-sphere";
const SIZE: [u32; 2] = [1024, 1024];
const PULL_PUSH: [Method; 2] = [pull_push::METHOD, pull_push::PAPER];

pub(super) fn plans() -> Vec<Plan> {
    // Every method at a few values; at all values the default one and, over points, pull–push.
    let plan = |experiment, points, size, every: bool| {
        let plan = Plan {
            measurements: Measurements::TIME,
            ..plan(Suite::Scaling, experiment, SCENE, points, size)
        };
        let all = move |plan: &Plan| {
            every || experiment == Experiment::ScalingPoints && plan.settings.pull_push.is_some()
        };
        let others = methods(&plan).filter(all);
        [plan.clone(), baseline(&plan, Kind::Splats)].into_iter().chain(others)
    };
    let points = [10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000];
    let mut plans: Vec<Plan> = Vec::new();
    for points in points {
        let every = [10_000, 100_000, 1_000_000].contains(&points);
        plans.extend(plan(Experiment::ScalingPoints, points, SIZE, every));
    }
    plans.extend(PULL_PUSH.map(|method| filled(&method)));
    for side in [256, 512, 1024, 2048, 4096] {
        plans.extend(plan(Experiment::ScalingSize, 1_000_000, [side; 2], [256, 1024, 4096].contains(&side)));
    }
    // Radii that give this overlap: those of the scene give 2.25 π.
    for overlap in [1.0f32, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0] {
        let radius_scale = (overlap / (2.25 * std::f32::consts::PI)).sqrt();
        let every = [1.0, 8.0, 64.0].contains(&overlap);
        let plans_of_it = plan(Experiment::ScalingOverlap, 300_000, SIZE, every);
        plans.extend(plans_of_it.map(|plan| Plan { radius_scale, ..plan }));
    }
    plans.extend(levels());
    plans
}

/// Levels of detail of a scene with many more points than pixels; 0 draws all points.
fn levels() -> impl Iterator<Item = Plan> {
    let methods = [perspective_ewa::METHOD, confetti::METHOD, pull_push::METHOD];
    let plan = plan(Suite::Scaling, Experiment::ScalingLevels, SCENE, 1_000_000, [256; 2]);
    let plan = Plan { measurements: Measurements::BOTH, ..plan };
    [0.0, 0.5, 1.0, 2.0, 4.0, 8.0].into_iter().flat_map(move |lod| {
        methods.map(|method| {
            let by = plan.clone().by(&method);
            Plan { settings: Settings { lod, ..by.settings.clone() }, ..by }
        })
    })
}

/// A plane that fills the picture with a point in every pixel and discs that reach all neighbours: every sample is
/// known and every candidate counts, which is the most work for pull–push.
fn filled(method: &Method) -> Plan {
    let viewpoint =
        Viewpoint { eye: [0.0, 14.0, 0.0], target: [0.0; 3], up: [0.0, 0.0, -1.0], fov_y_deg: 45.0 };
    let plan = plan(Suite::Scaling, Experiment::Filled, "scene:relief?height=0", 4_000_000, SIZE);
    Plan { measurements: Measurements::TIME, place: Place::Given(viewpoint), radius_scale: 4.0, ..plan }
        .by(method)
}
