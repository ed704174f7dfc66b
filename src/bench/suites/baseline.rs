//! Every engine, with times relative to the CPU baseline.

use super::{Suite, plan};
use crate::bench::engine::Engine;
use crate::bench::plan::{Measurements, Plan};
use crate::bench::record::Experiment;
use crate::verify::baseline::Kind;
use crate::{Precision, Rasterizer};

const SIZE: [u32; 2] = [1024, 1024];

pub(super) fn plans() -> Vec<Plan> {
    let vulkan = |rasterizer, precision| Engine::Splatting { rasterizer: Some(rasterizer), precision };
    let engines = [
        vulkan(Rasterizer::Compute, Precision::Full),
        vulkan(Rasterizer::Draw, Precision::Full),
        vulkan(Rasterizer::Draw, Precision::Half),
        Engine::Baseline(Kind::Splats),
        Engine::Baseline(Kind::Pixels),
    ];
    let plan = |points| Plan {
        measurements: Measurements::TIME,
        ..plan(Suite::Baseline, Experiment::Baseline, "scene:bumpy-sphere", points, SIZE)
    };
    let one = |points| engines.map(|engine| plan(points).by_engine(engine));
    [100_000, 1_000_000].map(one).concat()
}
