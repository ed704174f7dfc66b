//! Time against points, pixels and overlap.

use super::{Suite, plan, yardstick};
use crate::bench::plan::{Plan, Wants};
use crate::bench::record::Figure;
use crate::yardstick::Kind;

const SCENE: &str = "scene:bumpy-sphere";
const SIZE: [u32; 2] = [1024, 1024];

pub(super) fn plans() -> Vec<Plan> {
    let plan = |figure, points, size| {
        let plan = Plan { wants: Wants::TIME, ..plan(Suite::Scaling, figure, SCENE, points, size) };
        [plan.clone(), yardstick(&plan, Kind::Splats)]
    };
    let points = [10_000, 30_000, 100_000, 300_000, 1_000_000, 3_000_000, 10_000_000];
    let mut plans = points.map(|points| plan(Figure::ScalingPoints, points, SIZE)).concat();
    plans.extend(
        [256, 512, 1024, 2048, 4096].map(|side| plan(Figure::ScalingSize, 1_000_000, [side; 2])).concat(),
    );
    // Discs as large as leave so many over every point of the surface: the scene's own leave 2.25 π.
    for overlap in [1.0f32, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0] {
        let radius_scale = (overlap / (2.25 * std::f32::consts::PI)).sqrt();
        let plans_of_it = plan(Figure::ScalingOverlap, 300_000, SIZE);
        plans.extend(plans_of_it.map(|plan| Plan { radius_scale, ..plan }));
    }
    plans
}
