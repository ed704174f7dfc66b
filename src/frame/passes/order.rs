//! Order: surfels in arbitrary order → their order along a Morton curve (`order.glsl`), on the tile path, whose boxes of consecutive splats
//! must be small.

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::recording::row_over;
use crate::frame::resource::Resource::Order;
use crate::frame::scene_resources::ChunkRun;
use crate::vk::shaders::layout::OrderStep;
use crate::vk::shaders::{ORDER_COMPUTE, ORDER_SCAN_COMPUTE, ORDER_SCATTER_COMPUTE};
use crate::vk::{Access, ComputePipeline, Recorder};

/// Sorts the surfels of scenes in arbitrary order.
pub static ORDER: Pass = Pass {
    name: "order",
    reads: &[],
    writes: &[Order],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let modules = [&ORDER_COMPUTE, &ORDER_SCAN_COMPUTE, &ORDER_SCATTER_COMPUTE];
        let programs = modules.map(|module| Program::compute(module, Domain::Surfels));
        if variant.unordered { programs.into() } else { Vec::new() }
    }),
    commands: Commands::Steps(record),
};

/// Digits of a code of 24 bits: DIGIT_BITS of `order.glsl`.
const DIGITS: u32 = 3;
/// Values of a digit.
const DIGIT_VALUES: u64 = 1 << 8;
/// Most runs of entries, one per invocation.
const MOST_RUNS: u64 = 256;

/// Runs of entries in a sort of so many: a power of two of at least 8.
fn runs(entries: u64) -> u64 {
    (entries / 1024).next_power_of_two().clamp(8, MOST_RUNS)
}

/// Bytes of the order of a surfel: two arrays of indices and two of codes.
pub const SURFEL: u64 = 16;

/// Bytes of the order of so many surfels, with the counters of the sort.
pub fn bytes(surfels: u64) -> u64 {
    SURFEL * surfels + 4 * DIGIT_VALUES * runs(surfels)
}

fn record(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    for (pipelines, run) in steps.of_scenes() {
        let [count, scan, scatter] = pipelines[..] else { continue };
        // The order is that of all instances.
        let sorted = run.chunks(Domain::Surfels.scope(), &ORDER).into_iter().filter(|_| run.first == 0);
        for chunk in sorted.filter(|chunk| chunk.chunk.count > 0) {
            sort(steps, rec, [count, scan, scatter], &chunk, run.scene.order_cells());
        }
    }
}

fn sort(
    steps: &StepContext<'_>,
    rec: &mut Recorder<'_>,
    [count, scan, scatter]: [&ComputePipeline; 3],
    run: &ChunkRun<'_>,
    [low, scale]: [[f32; 4]; 2],
) {
    let (surfels, capacity) = (run.chunk.count, run.chunk.capacity);
    let runs = runs(capacity.into()) as u32;
    let grid = row_over(runs.into());
    for digit in 0..DIGITS {
        let step = OrderStep { low, scale, count: surfels, capacity, runs, digit };
        for (pipeline, grid) in [(count, grid), (scan, [1, 1, 1]), (scatter, grid)] {
            let mut enc = rec.pass(ORDER.name, &steps.frame.uses(&[(Order, Access::COMPUTE_WRITE)]));
            enc.dispatch(pipeline, &[run.set], &step, grid);
        }
    }
}
