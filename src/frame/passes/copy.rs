//! Copy: pulled samples of each level → the pyramid of the coarser level, from which push reads both (marroquim2008 §3.5, figure 7b;
//! `copy.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::resource::Resource::{Pulled, Pushed};
use crate::vk::Recorder;
use crate::vk::shaders::COPY_COMPUTE;

/// Completes both ping-pong pyramids.
pub static COPY: Pass = Pass {
    name: "copy",
    reads: &[Pulled],
    writes: &[Pushed],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&COPY_COMPUTE, Domain::Level)]),
    commands: Commands::Steps(record),
};

fn record(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let StepContext { pipeline: Some(pipeline), frame, .. } = steps else { return };
    let Some(pyramids) = &frame.targets.pyramids else { return };
    for level in 0..pyramids.levels.count() {
        let ([_, from], [to, _]) = (pyramids.storage.pull(level), pyramids.storage.push(level));
        let mut enc = rec.pass(COPY.name, &pyramids.uses([from, to]));
        let sets = steps.pyramid_sets([from, to]);
        enc.dispatch(pipeline, &sets, &pyramids.copy_step(level), pyramids.grid(level));
    }
}
