//! Visibility: splats → depth of the nearest surface, moved back by ε (zwicker2004 §6, first pass; `visibility.glsl`).

use super::tiles;
use crate::frame::pass::{Commands, Domain, DrawTargets, InitialContents, Pass, Program, Programs};
use crate::frame::resource::Resource::{
    self, Boxes, Coverage, IncompleteFrame, ScreenClips, Splats, Visibility,
};
use crate::frame::variant::Variant;
use crate::vk::shaders::{
    VISIBILITY_CLIP_LINES_FRAGMENT, VISIBILITY_CLIP_LINES_VERTEX, VISIBILITY_COMPUTE,
    VISIBILITY_COVERAGE_FRAGMENT, VISIBILITY_COVERAGE_VERTEX, VISIBILITY_FRAGMENT,
    VISIBILITY_SUBGROUPS_COMPUTE, VISIBILITY_VERTEX, constant,
};
use crate::vk::{Blend, DepthTest, Topology};

/// One workgroup per tile.
pub static COMPUTE: Pass = over_tiles(&[Visibility, Coverage], |variant| programs(variant, Domain::Tiles));

/// The same for splats that face the eye, before sides.
pub static COMPUTE_FRONTS: Pass = over_tiles(&[Visibility], |variant| programs(variant, Domain::FrontTiles));

/// The same for all splats, from the depths of those that face the eye.
pub static COMPUTE_ALL: Pass = over_tiles(&[Coverage], |variant| programs(variant, Domain::Tiles));

const fn over_tiles(clears: &'static [Resource], programs: fn(&Variant) -> Vec<Program>) -> Pass {
    Pass {
        name: "visibility",
        reads: &[Splats, Boxes, ScreenClips],
        writes: &[Visibility, Coverage, IncompleteFrame],
        clears,
        programs: Programs::OfFrame(programs),
        commands: Commands::Dispatches,
    }
}

fn programs(variant: &Variant, domain: Domain) -> Vec<Program> {
    let programs = tiles(variant, [&VISIBILITY_COMPUTE, &VISIBILITY_SUBGROUPS_COMPUTE]);
    programs.into_iter().map(|program| Program { domain, ..program }).collect()
}

/// Splat triangles with a depth test.
pub static RASTER: Pass = Pass {
    name: "visibility",
    reads: &[Splats, ScreenClips],
    writes: &[Coverage],
    clears: &[Coverage],
    programs: Programs::OfScene(|variant| {
        let modules = match (variant.frame.coverage, variant.clips) {
            (true, _) => [&VISIBILITY_COVERAGE_VERTEX, &VISIBILITY_COVERAGE_FRAGMENT],
            (false, true) => [&VISIBILITY_CLIP_LINES_VERTEX, &VISIBILITY_CLIP_LINES_FRAGMENT],
            (false, false) => [&VISIBILITY_VERTEX, &VISIBILITY_FRAGMENT],
        };
        vec![Program::draw(modules, Domain::SplatTriangles)]
    }),
    commands: Commands::Draws(DEPTH),
};

/// The same for splats that face the eye, before sides.
pub static RASTER_FRONTS: Pass = Pass {
    name: "visibility",
    reads: &[Splats, ScreenClips],
    writes: &[],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let modules = match variant.clips {
            true => [&VISIBILITY_CLIP_LINES_VERTEX, &VISIBILITY_CLIP_LINES_FRAGMENT],
            false => [&VISIBILITY_VERTEX, &VISIBILITY_FRAGMENT],
        };
        vec![Program::draw(modules, Domain::SplatTriangles).with(constant::FRONTS, true)]
    }),
    commands: Commands::Draws(DEPTH),
};

/// Depth alone.
const DEPTH: DrawTargets = DrawTargets {
    colours: &[],
    depth: Some((Visibility, InitialContents::Cleared)),
    topology: Topology::Triangles,
    test: DepthTest::Nearest,
    blend: Blend::Replace,
};
