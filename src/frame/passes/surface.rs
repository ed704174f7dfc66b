//! Surface: splats → picture, normal, depth: visibility, attribute and normalize tile by tile, in one dispatch (zwicker2004 §6; `surface.glsl`).

use super::tiles;
use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{
    self, Attributes, Boxes, Coverage, CoveredTiles, Depth, EdgeTiles, Image, IncompleteFrame, Normal,
    OpenTiles, RevealedTiles, ScreenClips, Splats, Visibility,
};
use crate::frame::variant::Variant;
use crate::vk::shaders::{SURFACE_COMPUTE, SURFACE_SUBGROUPS_COMPUTE, constant};

const READS: &[Resource] = &[Splats, Boxes, Attributes, ScreenClips, CoveredTiles];
const WRITES: &[Resource] =
    &[Visibility, OpenTiles, EdgeTiles, RevealedTiles, Coverage, Image, Normal, Depth, IncompleteFrame];

/// One workgroup per tile that splats may cover.
pub static SURFACE: Pass =
    over(&[EdgeTiles, Image, Normal, Depth], |variant| programs_over(variant, Domain::CoveredTiles));

/// The same for the splats that face the eye, before sides.
pub static FRONTS: Pass = over(&[Visibility, OpenTiles, EdgeTiles, Image, Normal, Depth], |variant| {
    programs_over(variant, Domain::CoveredFrontTiles)
});

/// The same again in the tiles of revealed clusters.
pub static REVEALED: Pass = over(&[], |variant| programs_over(variant, Domain::RevealedTiles));

/// The same for the tiles that sides has opened.
pub static OPEN: Pass = over(&[], |variant| programs_over(variant, Domain::OpenTiles));

const fn over(clears: &'static [Resource], programs: fn(&Variant) -> Vec<Program>) -> Pass {
    Pass {
        name: "surface",
        reads: READS,
        writes: WRITES,
        clears,
        programs: Programs::OfFrame(programs),
        commands: Commands::Dispatches,
    }
}

fn programs_over(variant: &Variant, domain: Domain) -> Vec<Program> {
    programs(variant).into_iter().map(|program| Program { domain, ..program }).collect()
}

fn programs(variant: &Variant) -> Vec<Program> {
    let programs = tiles(variant, [&SURFACE_COMPUTE, &SURFACE_SUBGROUPS_COMPUTE]);
    programs.into_iter().map(|program| program.with(constant::MIXED, variant.mixed)).collect()
}
