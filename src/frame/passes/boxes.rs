//! Boxes: boxes of splats → boxes of the nodes above them, level by level (`boxes.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::recording::{self, REVEALED_FRONTS, grid_over};
use crate::frame::resource::Resource;
use crate::frame::variant::Variant;
use crate::vk::shaders::layout::Level;
use crate::vk::shaders::{BOXES_COMPUTE, BOXES_SUBGROUPS_COMPUTE};
use crate::vk::{Access, Recorder};

/// The boxes of splats that face the eye, before sides.
pub static FRONTS: Pass = Pass {
    name: "boxes",
    reads: &[],
    writes: &[Resource::Boxes],
    clears: &[],
    programs: Programs::OfFrame(programs),
    commands: Commands::Steps(|steps, rec| record(steps, rec, recording::FRONTS)),
};

/// The same again, if there are revealed clusters.
pub static REVEALED: Pass = Pass {
    name: "boxes",
    reads: &[Resource::RevealedTiles],
    writes: &[Resource::Boxes],
    clears: &[],
    programs: Programs::OfFrame(programs),
    commands: Commands::Steps(|steps, rec| record(steps, rec, REVEALED_FRONTS)),
};

/// One dispatch for the levels up to clusters and one per level above, one invocation per node of the highest.
pub static BOXES: Pass = Pass {
    name: "boxes",
    reads: &[],
    writes: &[Resource::Boxes],
    clears: &[],
    programs: Programs::OfFrame(programs),
    commands: Commands::Steps(|steps, rec| record(steps, rec, 0)),
};

fn programs(variant: &Variant) -> Vec<Program> {
    let module = if variant.workgroup.subgroups { &BOXES_SUBGROUPS_COMPUTE } else { &BOXES_COMPUTE };
    vec![Program::compute(module, Domain::Level)]
}

fn record(steps: &StepContext<'_>, rec: &mut Recorder<'_>, fronts: u32) {
    let (Some(pipeline), Some(splats)) = (steps.pipeline, steps.frame.splats) else { return };
    let sets = [steps.frame.view, steps.targets];
    for level in splats.steps(steps.frame.splat_count) {
        let mut uses = vec![splats.boxes().with(Access::COMPUTE_WRITE)];
        if fronts == REVEALED_FRONTS {
            steps.frame.targets.extend_uses(&mut uses, Resource::RevealedTiles, Access::COMPUTE_READ);
        }
        let mut enc = rec.pass(BOXES.name, &uses);
        enc.dispatch(pipeline, &sets, &Level { fronts, ..level }, grid_over(level.count.into()));
    }
}
