//! Cull: bounds of clusters of surfels → list of those that may have splats or points, on the compute path (`cull.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{Boxes, Counts, HiddenClusters, VisibleClusters};
use crate::vk::shaders::{CULL_COMPUTE, CULL_TILES_COMPUTE, constant};

/// One workgroup per group of clusters that the CPU has not culled; scenes without bounds have all of theirs listed.
pub static CULL: Pass = Pass {
    name: "cull",
    reads: &[],
    writes: &[Boxes, VisibleClusters, HiddenClusters, Counts],
    clears: &[VisibleClusters, HiddenClusters],
    programs: Programs::OfScene(|variant| {
        let module = if variant.frame.is_tiled() { &CULL_TILES_COMPUTE } else { &CULL_COMPUTE };
        vec![Program::compute(module, Domain::Clusters).with(constant::BOUNDED, variant.bounded)]
    }),
    commands: Commands::Dispatches,
};
