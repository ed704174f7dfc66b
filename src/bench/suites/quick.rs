//! A first impression of everything.

use super::{Suite, aliasing, baselines, every, lowpass, plan, unfiltered};
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::bench::subject::Subject;
use crate::settings::Shading;
use crate::settings::methods::{Method, pull_push};
use std::rc::Rc;

const SIZE: [u32; 2] = [320, 320];
const POINTS: [u64; 3] = [10_000, 100_000, 1_000_000];
/// Number of points of the runs with pictures.
const MIDDLE: u64 = 100_000;

/// Two scenes, one of them lit, and the first scan, lit; another scene takes its place if there is none.
pub(super) fn plans(scans: &[Rc<Subject>]) -> Vec<Plan> {
    let mut plans = scene("scene:bumpy-sphere", Shading::Colour, false);
    plans.extend(scene("scene:torus", Shading::Lit, true));
    match scans.first() {
        Some(scan) => plans.extend(of_scan(scan)),
        None => plans.extend(scene("scene:part", Shading::Lit, false)),
    }
    plans.extend(lowpass(Suite::Quick, "scene:bumpy-sphere", MIDDLE, SIZE, &[0.0, 0.5, 1.0], &[1.5, 3.5]));
    plans.extend(aliasing(Suite::Quick, [256, 256]));
    plans
}

/// Every density; at one also every method, if `by_all`: more would take more than a minute.
fn scene(name: &str, shading: Shading, by_all: bool) -> Vec<Plan> {
    let each = |points| {
        let mut plan = plan(Suite::Quick, Experiment::Budget, name, points, SIZE);
        plan.settings.shading = shading;
        // The parts of the error, where the float64 reference is fast.
        let few = points <= MIDDLE;
        plan.measurements =
            Measurements { terms: few, float64_error: few, images: points == MIDDLE, ..Measurements::BOTH };
        match points {
            MIDDLE if by_all => every(&plan, &Method::OWN, Measurements::BOTH),
            MIDDLE => some(&plan).into_iter().chain(baselines(&plan).into_iter().last()).collect(),
            _ => some(&plan),
        }
    };
    POINTS.into_iter().flat_map(each).collect()
}

/// The default plan, the same without any filter, by pull–push, and by the CPU baseline.
fn some(plan: &Plan) -> Vec<Plan> {
    let others = |settings| Plan { measurements: Measurements::BOTH, settings, ..plan.clone() };
    let sharp = others(unfiltered(&plan.settings));
    let pull_push = others(plan.settings.clone()).by(&pull_push::METHOD);
    let [splats, pixels, _] = baselines(plan);
    vec![plan.clone(), sharp, pull_push, splats, pixels]
}

/// A scan at its greatest density, up to a million points: every method, but where the surface is unknown, and each would need a reference of its
/// own, the default one and pull–push only.
fn of_scan(scan: &Subject) -> Vec<Plan> {
    let points = scan.most_points().unwrap_or(MIDDLE).min(1_000_000);
    let mut plan = plan(Suite::Quick, Experiment::Budget, &scan.name, points, SIZE);
    plan.settings.shading = Shading::Lit;
    plan.measurements = Measurements { images: true, ..Measurements::BOTH };
    if scan.surface().is_some() {
        every(&plan, &Method::OWN, Measurements::BOTH)
    } else {
        vec![plan.clone(), plan.by(&pull_push::METHOD)]
    }
}
