//! Footprint: surfels → splats, culled and counted (zwicker2004 §4; `footprint.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{
    Attributes, Boxes, Counts, Order, ScreenClips, Splats, VisibleClusters,
};
use crate::frame::scene_variant::SceneVariant;
use crate::vk::shaders::{FOOTPRINT_COMPUTE, FOOTPRINT_TILES_COMPUTE, constant};

/// One invocation per surfel; on the tile path of the visible clusters or, as its lists have no gaps, of the capacity.
fn footprint(variant: &SceneVariant) -> Program {
    let domain = if variant.frame.clusters { Domain::VisibleClusters } else { Domain::SurfelSlots };
    if variant.frame.is_tiled() {
        Program::compute(&FOOTPRINT_TILES_COMPUTE, domain)
    } else {
        Program::compute(&FOOTPRINT_COMPUTE, Domain::Surfels)
    }
}

/// Surfels of each scene → its splats and counters.
pub static FOOTPRINT: Pass = Pass {
    name: "footprint",
    reads: &[Order, VisibleClusters],
    writes: &[Splats, Boxes, Attributes, ScreenClips, Counts],
    clears: &[],
    programs: Programs::OfScene(|variant| vec![footprint(variant)]),
    commands: Commands::Dispatches,
};

/// Those of revealed clusters.
pub static REVEALED: Pass = Pass {
    name: "footprint",
    reads: &[Order, VisibleClusters],
    writes: &[Splats, Boxes, Attributes, ScreenClips, Counts],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let program = Program::compute(&FOOTPRINT_TILES_COMPUTE, Domain::RevealedClusters);
        if variant.bounded { vec![program] } else { Vec::new() }
    }),
    commands: Commands::Dispatches,
};

/// Footprints of discs moved by ε along the camera's axis, for visibility; a constant disables counting.
pub static MOVED: Pass = Pass {
    name: "footprint",
    reads: &[Order, VisibleClusters],
    writes: &[Splats, Boxes, Attributes, ScreenClips, Counts],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        vec![footprint(variant).with(constant::MOVED, true).with(constant::COUNT, false)]
    }),
    commands: Commands::Dispatches,
};
