//! Copy: pulled samples of each level → the pyramid of the coarser level, from which push reads both (marroquim2008 §3.5, figure 7b).

use crate::frame::pass::{Commands, Pass, Programs, StepContext};
use crate::frame::resource::Resource::{Pulled, Pushed};
use crate::vk::{Access, Recorder};

/// Completes both ping-pong pyramids.
pub static COPY: Pass = Pass {
    name: "copy",
    reads: &[Pulled],
    writes: &[Pushed],
    clears: &[],
    programs: Programs::None,
    commands: Commands::Steps(record),
};

fn record(StepContext { frame, .. }: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let Some(pyramids) = &frame.targets.pyramids else { return };
    let uses = pyramids.pyramids.iter().flat_map(|pyramid| pyramid.with(Access::COPY_WITHIN));
    let mut enc = rec.pass(COPY.name, &uses.collect::<Vec<_>>());
    for level in 0..pyramids.levels() {
        let [_, from] = pyramids.storage.pull(level);
        let [to, _] = pyramids.storage.push(level);
        pyramids.pyramids[from].copy(&mut enc, &pyramids.pyramids[to], pyramids.level_range(level));
    }
}
