//! Every scene, by every method.

use super::{Suite, UserInputs, aliasing, every, inputs, lowpass, plan, triangle_renderer};
use crate::bench::place::{Move, Place};
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::bench::subject::Subject;
use crate::settings::Shading;
use crate::settings::methods::Method;
use crate::verify::scenes;
use std::rc::Rc;
use strum::VariantArray;

const SIZE: [u32; 2] = [512, 512];
const POINTS: [u64; 5] = [10_000, 30_000, 100_000, 300_000, 1_000_000];
/// Number of points of the runs with pictures and from other viewpoints.
const MIDDLE: u64 = 100_000;
/// Sides of the other pictures, px.
const SIDES: [u32; 4] = [64, 128, 256, 1024];

/// `scans` are rendered at every density as the user's inputs are.
pub(super) fn plans(scans: &[Rc<Subject>]) -> Vec<Plan> {
    // The disc is for a single surfel.
    let scenes = || scenes::list().iter().map(|scene| scene.name).filter(|name| *name != "scene:disc");
    let mut plans: Vec<_> = scenes().flat_map(densities).collect();
    let scans = UserInputs { subjects: scans.to_vec(), ..Default::default() };
    plans.extend(inputs::plans(Suite::Full, &scans));
    plans.extend(scenes().flat_map(views));
    let (variances, cutoffs) = ([0.0, 0.25, 0.5, 0.75, 1.0], [1.5, 2.0, 2.5, 3.0, 3.5, 4.0]);
    for (scene, points) in
        [("scene:bumpy-sphere", 100_000), ("scene:bumpy-sphere", 1_000_000), ("scene:plane", 1_000_000)]
    {
        plans.extend(lowpass(Suite::Full, scene, points, SIZE, &variances, &cutoffs));
    }
    plans.extend(aliasing(Suite::Full, [256, 256]));
    plans
}

fn lit(experiment: Experiment, scene: &str, points: u64) -> Plan {
    let mut plan = plan(Suite::Full, experiment, scene, points, SIZE);
    plan.settings.shading = Shading::Lit;
    plan
}

/// A scene at every density, lit and in its colours.
fn densities(scene: &str) -> Vec<Plan> {
    let each = |(points, shading)| {
        let mut plan = lit(Experiment::Budget, scene, points);
        plan.settings.shading = shading;
        // Pictures of every method are shown for one scene only.
        let images = points == MIDDLE && shading == Shading::Lit;
        let float64_error = points <= MIDDLE;
        plan.measurements = Measurements { terms: true, float64_error, images, ..Measurements::BOTH };
        let others = Measurements { images: images && scene == "scene:bumpy-sphere", ..Measurements::BOTH };
        let triangles = (points == MIDDLE).then(|| triangle_renderer(&plan));
        every(&plan, &Method::ALL, others).into_iter().chain(triangles).collect::<Vec<_>>()
    };
    let shadings = [Shading::Lit, Shading::Colour];
    POINTS.into_iter().flat_map(|points| shadings.map(|shading| (points, shading))).flat_map(each).collect()
}

/// A scene from other sides and distances, and in other sizes.
fn views(scene: &str) -> Vec<Plan> {
    let middle = lit(Experiment::Views, scene, MIDDLE);
    let moved = Move::VARIANTS.iter().map(|how| Plan { place: Place::Moved(*how), ..middle.clone() });
    let sized = SIDES.map(|side| Plan { size: [side; 2], ..middle.clone() });
    moved.chain(sized).flat_map(|plan| every(&plan, &Method::ALL, Measurements::BOTH)).collect()
}
