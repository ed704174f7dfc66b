//! Nearest: splats → the nearest one of each pixel, unblended (zwicker2004 table 1; botsch2003 §3.2; `nearest.glsl`).

use super::tiles;
use crate::frame::pass::{Commands, Domain, DrawTargets, InitialContents, Pass, Program, Programs};
use crate::frame::resource::Resource::{
    Attributes, Boxes, Coverage, CoveredTiles, Depth, Image, IncompleteFrame, Normal, ScreenClips, Splats,
    Sums0, Sums1, Visibility,
};
use crate::vk::shaders::{
    NEAREST_CLIP_LINES_FRAGMENT, NEAREST_CLIP_LINES_VERTEX, NEAREST_COMPUTE, NEAREST_COVERAGE_FRAGMENT,
    NEAREST_COVERAGE_VERTEX, NEAREST_FRAGMENT, NEAREST_SLICES_COMPUTE, NEAREST_SUBGROUPS_COMPUTE,
    NEAREST_SUBGROUPS_SLICES_COMPUTE, NEAREST_VERTEX,
};
use crate::vk::{Blend, DepthTest, Topology};

/// One workgroup per tile that splats may cover; writes the picture.
pub static COMPUTE: Pass = Pass {
    name: "nearest",
    reads: &[Splats, Boxes, Attributes, ScreenClips, CoveredTiles],
    writes: &[Image, Normal, Depth, IncompleteFrame],
    clears: &[Image, Normal, Depth],
    programs: Programs::OfFrame(|variant| {
        let programs = tiles(variant, [&NEAREST_COMPUTE, &NEAREST_SUBGROUPS_COMPUTE]);
        programs.into_iter().map(|program| Program { domain: Domain::CoveredTiles, ..program }).collect()
    }),
    commands: Commands::Dispatches,
};

/// One workgroup per tile and slice; the last slice writes the picture.
pub static SLICED: Pass = Pass {
    name: "nearest",
    reads: &[Splats, Boxes, Attributes, ScreenClips],
    writes: &[Visibility, Sums0, Coverage, Image, Normal, Depth, IncompleteFrame],
    clears: &[Image, Normal, Depth],
    programs: Programs::OfFrame(|variant| {
        tiles(variant, [&NEAREST_SLICES_COMPUTE, &NEAREST_SUBGROUPS_SLICES_COMPUTE])
    }),
    commands: Commands::Dispatches,
};

/// Splat triangles with a depth test; write the splat's attributes as sums.
pub static RASTER: Pass = Pass {
    name: "nearest",
    reads: &[Splats, ScreenClips],
    writes: &[Coverage],
    clears: &[Coverage],
    programs: Programs::OfScene(|variant| {
        let modules = match (variant.frame.coverage, variant.clips) {
            (true, _) => [&NEAREST_COVERAGE_VERTEX, &NEAREST_COVERAGE_FRAGMENT],
            (false, true) => [&NEAREST_CLIP_LINES_VERTEX, &NEAREST_CLIP_LINES_FRAGMENT],
            (false, false) => [&NEAREST_VERTEX, &NEAREST_FRAGMENT],
        };
        vec![Program::draw(modules, Domain::SplatTriangles)]
    }),
    commands: Commands::Draws(DrawTargets {
        colours: &[(Sums0, InitialContents::Cleared), (Sums1, InitialContents::Cleared)],
        depth: Some((Visibility, InitialContents::Cleared)),
        topology: Topology::Triangles,
        test: DepthTest::Nearest,
        blend: Blend::Replace,
    }),
};
