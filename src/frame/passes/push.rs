//! Push: the pulled pyramid → the final one, coarse to fine (marroquim2008 §3.3; `push.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::resource::Resource::{FilledTiles, Pulled, Pushed};
use crate::frame::tile_list::{LISTED_LEVELS, workgroups_at};
use crate::frame::variant::Variant;
use crate::vk::shaders::PUSH_COMPUTE;
use crate::vk::{Access, Recorder};

/// Pulled levels from 3 on → pushed levels.
pub static COARSE: Pass =
    pass(|_| vec![Program::compute(&PUSH_COMPUTE, Domain::CoarseLevels)], record_coarse);

/// Levels 0 to 2 in filled tiles, without level 0 if shade reconstructs it.
pub static FINE: Pass = pass(|_| vec![Program::compute(&PUSH_COMPUTE, Domain::Level)], record_fine);

const fn pass(
    programs: fn(&Variant) -> Vec<Program>,
    record: fn(&StepContext<'_>, &mut Recorder<'_>),
) -> Pass {
    Pass {
        name: "push",
        reads: &[Pulled, FilledTiles],
        writes: &[Pushed],
        clears: &[],
        programs: Programs::OfFrame(programs),
        commands: Commands::Steps(record),
    }
}

fn record_coarse(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let StepContext { pipeline: Some(pipeline), frame, .. } = steps else { return };
    let (Some(pyramids), Some(list)) = (&frame.targets.pyramids, frame.targets.buffer(FilledTiles)) else {
        return;
    };
    for level in (LISTED_LEVELS..pyramids.levels.count()).rev() {
        let pair = pyramids.storage.push(level);
        let mut uses = pyramids.uses(pair);
        // The shader may read the list on any level.
        uses.push(list.with(Access::COMPUTE_READ));
        let mut enc = rec.pass(COARSE.name, &uses);
        enc.dispatch(pipeline, &steps.pyramid_sets(pair), &pyramids.push_step(level), pyramids.grid(level));
    }
}

fn record_fine(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let StepContext { pipeline: Some(pipeline), frame, .. } = steps else { return };
    let (Some(pyramids), Some(list)) = (&frame.targets.pyramids, frame.targets.buffer(FilledTiles)) else {
        return;
    };
    let finest = pyramids.finest_pushed();
    for level in (finest..pyramids.levels.count().min(LISTED_LEVELS)).rev() {
        let pair = pyramids.storage.push(level);
        let mut uses = pyramids.uses(pair);
        uses.push(list.with(Access::COMPUTE_READ.and_indirect()));
        let workgroups = (list, workgroups_at(level));
        let mut enc = rec.pass(FINE.name, &uses);
        enc.dispatch_indirect(pipeline, &steps.pyramid_sets(pair), &pyramids.push_step(level), workgroups);
    }
}
