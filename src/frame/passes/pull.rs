//! Pull: a level of the pulled pyramid → the next coarser one (marroquim2008 §3.2; `pull.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::resource::Resource::{OccupiedTiles, Pulled};
use crate::frame::tile_list::{LISTED_LEVELS, workgroups_at};
use crate::settings::pull_push::Storage;
use crate::vk::shaders::PULL_COMPUTE;
use crate::vk::{Access, Recorder};

/// Level 0 of the pulled pyramid → all others; the finest ones in occupied tiles, unless pyramids alternate by level.
pub static PULL: Pass = Pass {
    name: "pull",
    reads: &[OccupiedTiles],
    writes: &[Pulled],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&PULL_COMPUTE, Domain::Level)]),
    commands: Commands::Steps(record),
};

fn record(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let StepContext { pipeline: Some(pipeline), frame, .. } = steps else { return };
    let (Some(pyramids), Some(list)) = (&frame.targets.pyramids, frame.targets.buffer(OccupiedTiles)) else {
        return;
    };
    for level in 1..pyramids.levels.count() {
        let pair = pyramids.storage.pull(level);
        let (sets, step) = (steps.pyramid_sets(pair), pyramids.pull_step(level));
        let mut uses = pyramids.uses(pair);
        // The shader may read the list on any level.
        uses.push(list.with(Access::COMPUTE_READ.and_indirect()));
        let mut enc = rec.pass(PULL.name, &uses);
        if level < LISTED_LEVELS && pyramids.storage == Storage::Apart {
            enc.dispatch_indirect(pipeline, &sets, &step, (list, workgroups_at(level)));
        } else {
            enc.dispatch(pipeline, &sets, &step, pyramids.grid(level));
        }
    }
}
