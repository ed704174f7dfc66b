//! Shade: the final level 0 → picture, normal, depth (marroquim2008 §3.4; `shade.glsl`). Unless a pixel needs its neighbours, it reconstructs
//! level 0 itself.

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::resource::Resource::{Depth, FilledTiles, Id, Image, Normal, Pulled, Pushed};
use crate::vk::shaders::{
    SHADE_COMPUTE, SHADE_LOOKUPS_COMPUTE, SHADE_LOOKUPS_STORE_IDS_COMPUTE, SHADE_STORE_IDS_COMPUTE,
};
use crate::vk::{Access, Recorder};

/// One invocation per pixel of filled tiles; with a texture or materials, the variant that looks these up.
pub static SHADE: Pass = Pass {
    name: "shade",
    reads: &[Pulled, Pushed, FilledTiles],
    writes: &[Image, Normal, Depth, Id],
    clears: &[],
    programs: Programs::OfFrame(|variant| {
        let module = match (variant.texture.is_some() || variant.materials, variant.outputs.id) {
            (false, false) => &SHADE_COMPUTE,
            (false, true) => &SHADE_STORE_IDS_COMPUTE,
            (true, false) => &SHADE_LOOKUPS_COMPUTE,
            (true, true) => &SHADE_LOOKUPS_STORE_IDS_COMPUTE,
        };
        vec![Program::compute(module, Domain::Level)]
    }),
    commands: Commands::Steps(record),
};

fn record(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let StepContext { pipeline: Some(pipeline), frame, .. } = steps else { return };
    let (Some(pyramids), Some(list)) = (&frame.targets.pyramids, frame.targets.buffer(FilledTiles)) else {
        return;
    };
    let outputs = [Image, Normal, Depth, Id].map(|output| (output, Access::COMPUTE_WRITE));
    let read = pyramids.pyramids.iter().flat_map(|pyramid| pyramid.with(Access::COMPUTE_READ));
    let tiles = list.with(Access::COMPUTE_READ.and_indirect());
    let uses: Vec<_> = frame.uses(&outputs).into_iter().chain(read).chain([tiles]).collect();
    let mut enc = rec.pass(SHADE.name, &uses);
    enc.dispatch_indirect(pipeline, &steps.shade_sets(), &pyramids.push_step(0), (list, 0));
}
