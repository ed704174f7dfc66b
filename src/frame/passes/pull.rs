//! Pull: a level of the pulled pyramid → the next coarser one (marroquim2008 §3.2; `pull.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::resource::Resource::Pulled;
use crate::vk::Recorder;
use crate::vk::shaders::PULL_COMPUTE;

/// Level 0 of the pulled pyramid → all others.
pub static PULL: Pass = Pass {
    name: "pull",
    reads: &[],
    writes: &[Pulled],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&PULL_COMPUTE, Domain::Level)]),
    commands: Commands::Steps(record),
};

fn record(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let StepContext { pipeline: Some(pipeline), frame, .. } = steps else { return };
    let Some(pyramids) = &frame.targets.pyramids else { return };
    for level in 1..pyramids.levels.count() {
        let pair = pyramids.storage.pull(level);
        let mut enc = rec.pass(PULL.name, &pyramids.uses(pair));
        enc.dispatch(pipeline, &steps.pyramid_sets(pair), &pyramids.pull_step(level), pyramids.grid(level));
    }
}
