//! Hidden: clusters that pass cull has left → those of them that nothing hides, and the tiles that these may change; which clusters are hidden
//! (two-phase occlusion culling; `hidden.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{
    Boxes, Counts, HiddenClusters, OpenTiles, RevealedTiles, VisibleClusters,
};
use crate::vk::shaders::HIDDEN_COMPUTE;

/// One workgroup per group of clusters.
pub static HIDDEN: Pass = Pass {
    name: "hidden",
    reads: &[],
    writes: &[Boxes, VisibleClusters, HiddenClusters, OpenTiles, RevealedTiles, Counts],
    clears: &[RevealedTiles],
    programs: Programs::OfScene(|variant| {
        let program = Program::compute(&HIDDEN_COMPUTE, Domain::Clusters);
        if variant.bounded { vec![program] } else { Vec::new() }
    }),
    commands: Commands::Dispatches,
};
