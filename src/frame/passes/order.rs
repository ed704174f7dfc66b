//! Order: surfels in arbitrary order → their order along a Morton curve (`order.glsl`), on the tile path, whose boxes of consecutive splats
//! must be small.

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::recording::row_over;
use crate::frame::resource::Resource::Order;
use crate::frame::scene_resources::ChunkRun;
use crate::frame::surfel_order::SurfelOrder;
use crate::vk::shaders::layout::{Chunk, OrderStep};
use crate::vk::shaders::{ORDER_COMPUTE, ORDER_SCAN_COMPUTE, ORDER_SCATTER_COMPUTE, ORDER_TOTALS_COMPUTE};
use crate::vk::{Access, Capabilities, ComputePipeline, Recorder};

/// Sorts the surfels of scenes in arbitrary order.
pub static ORDER: Pass = Pass {
    name: "order",
    reads: &[],
    writes: &[Order],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let modules = [&ORDER_COMPUTE, &ORDER_TOTALS_COMPUTE, &ORDER_SCAN_COMPUTE, &ORDER_SCATTER_COMPUTE];
        let programs = modules.map(|module| Program::compute(module, Domain::Surfels));
        if variant.unordered { programs.into() } else { Vec::new() }
    }),
    commands: Commands::Steps(record),
};

/// Indices of the programs, in order.
const COUNT: usize = 0;
const TOTALS: usize = 1;
const SCAN: usize = 2;
const SCATTER: usize = 3;

/// Digits of a code of 30 bits: LAST_DIGIT of `order.glsl`.
const DIGITS: u32 = 4;
/// Values of a digit.
const DIGIT_VALUES: u64 = 1 << 8;
/// Entries of a run, while runs are no more than the device's most.
const RUN: u64 = 256;

/// Runs of entries in a sort of so many, one per invocation: at least 8.
fn runs(entries: u64, capabilities: &Capabilities) -> u64 {
    entries.div_ceil(RUN).clamp(8, u64::from(capabilities.max_sort_runs))
}

/// Bytes of the order of a surfel: two arrays of indices and two of codes.
pub const SURFEL: u64 = 16;

/// Bytes of the order of so many surfels, with the counters of the sort.
pub fn bytes(surfels: u64, capabilities: &Capabilities) -> u64 {
    SURFEL * surfels + 4 * DIGIT_VALUES * (runs(surfels, capabilities) + 1)
}

/// The sort of a chunk of a scene: pipelines by program, the chunk, and the order of the scene.
type Sort<'a> = ([&'a ComputePipeline; 4], ChunkRun<'a>, &'a SurfelOrder);

fn record(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let mut sorts: Vec<Sort<'_>> = Vec::new();
    for (pipelines, run) in steps.of_scenes() {
        // The order is that of all instances.
        let (Ok(pipelines), Some(order), 0) = (<[_; 4]>::try_from(pipelines), run.scene.order(), run.first)
        else {
            continue;
        };
        let chunks = run.chunks(Domain::Surfels.scope(), &ORDER).into_iter();
        let sorted = chunks.filter(|chunk| chunk.chunk.count > 0);
        sorts.extend(sorted.map(|chunk| (pipelines, chunk, order)));
    }
    if sorts.is_empty() {
        return;
    }
    let uses = steps.frame.uses(&[(Order, Access::COMPUTE_WRITE)]);
    for (digit, program) in
        (0..DIGITS).flat_map(|digit| [COUNT, TOTALS, SCAN, SCATTER].map(|program| (digit, program)))
    {
        let mut enc = rec.pass(ORDER.name, &uses);
        for (pipelines, run, order) in &sorts {
            let Chunk { count, capacity, .. } = run.chunk;
            let runs = runs(capacity.into(), order.capabilities()) as u32;
            let step = OrderStep { curve: order.curve(), count, capacity, runs, digit };
            let is_over_digits = [TOTALS, SCAN].contains(&program);
            let grid = if is_over_digits { [DIGIT_VALUES as u32, 1, 1] } else { row_over(runs.into()) };
            enc.dispatch(pipelines[program], &[run.set], &step, grid);
        }
    }
}
