//! Push: the pulled pyramid → the final one, coarse to fine (marroquim2008 §3.3; `push.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::resource::Resource::{Pulled, Pushed};
use crate::vk::Recorder;
use crate::vk::shaders::PUSH_COMPUTE;

/// All pulled levels → pushed levels, without level 0 if shade reconstructs it.
pub static PUSH: Pass = Pass {
    name: "push",
    reads: &[Pulled],
    writes: &[Pushed],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&PUSH_COMPUTE, Domain::Level)]),
    commands: Commands::Steps(record),
};

fn record(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let StepContext { pipeline: Some(pipeline), frame, .. } = steps else { return };
    let Some(pyramids) = &frame.targets.pyramids else { return };
    for level in (pyramids.finest_pushed()..pyramids.levels.count()).rev() {
        let pair = pyramids.storage.push(level);
        let mut enc = rec.pass(PUSH.name, &pyramids.uses(pair));
        enc.dispatch(pipeline, &steps.pyramid_sets(pair), &pyramids.push_step(level), pyramids.grid(level));
    }
}
