//! Time against points, pixels and overlap.

use super::{Suite, methods, plan, yardstick};
use crate::bench::plan::{Plan, Wants};
use crate::bench::record::Figure;
use crate::yardstick::Kind;

const SCENE: &str = "scene:bumpy-sphere";
const SIZE: [u32; 2] = [1024, 1024];

pub(super) fn plans() -> Vec<Plan> {
    // Every method at a few of the places.
    let plan = |figure, points, size, every: bool| {
        let plan = Plan { wants: Wants::TIME, ..plan(Suite::Scaling, figure, SCENE, points, size) };
        let others = methods(&plan).filter(move |_| every);
        [plan.clone(), yardstick(&plan, Kind::Splats)].into_iter().chain(others)
    };
    let points = [10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000];
    let mut plans: Vec<Plan> = Vec::new();
    for points in points {
        let every = [10_000, 100_000, 1_000_000].contains(&points);
        plans.extend(plan(Figure::ScalingPoints, points, SIZE, every));
    }
    for side in [256, 512, 1024, 2048, 4096] {
        plans.extend(plan(Figure::ScalingSize, 1_000_000, [side; 2], [256, 1024, 4096].contains(&side)));
    }
    // Discs as large as leave so many over every point of the surface: the scene's own leave 2.25 π.
    for overlap in [1.0f32, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0] {
        let radius_scale = (overlap / (2.25 * std::f32::consts::PI)).sqrt();
        let every = [1.0, 8.0, 64.0].contains(&overlap);
        let plans_of_it = plan(Figure::ScalingOverlap, 300_000, SIZE, every);
        plans.extend(plans_of_it.map(|plan| Plan { radius_scale, ..plan }));
    }
    plans
}
