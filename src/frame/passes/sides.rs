//! Sides: splats → those that face the eye, and the backs of open surfaces; on the tile path also the tiles that these may change
//! (`sides.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{Boxes, Counts, OpenTiles, Splats, Visibility, VisibleClusters};
use crate::frame::scene_variant::SceneVariant;
use crate::vk::shaders::{SIDES_COMPUTE, SIDES_TILES_COMPUTE, constant};

/// One invocation per surfel; on the tile path of the visible clusters, or of the capacity.
pub static SIDES: Pass = Pass {
    name: "sides",
    reads: &[Visibility, VisibleClusters],
    writes: &[Splats, Boxes, OpenTiles, Counts],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let domain = if variant.frame.clusters { Domain::VisibleClusters } else { Domain::SurfelSlots };
        vec![match variant.frame.is_tiled() {
            true => over(variant, domain),
            false => Program::compute(&SIDES_COMPUTE, Domain::Surfels),
        }]
    }),
    commands: Commands::Dispatches,
};

/// The same of revealed clusters.
pub static REVEALED: Pass = Pass {
    name: "sides",
    reads: &[Visibility, VisibleClusters],
    writes: &[Splats, Boxes, OpenTiles, Counts],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        if variant.bounded { vec![over(variant, Domain::RevealedClusters)] } else { Vec::new() }
    }),
    commands: Commands::Dispatches,
};

fn over(variant: &SceneVariant, domain: Domain) -> Program {
    Program::compute(&SIDES_TILES_COMPUTE, domain).with(constant::OPENS_TILES, variant.frame.opens_tiles())
}
