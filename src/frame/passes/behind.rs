//! Behind: picture, splats → picture in which pixels at edges show the surface behind, too (`behind.glsl`).

use super::tiles;
use crate::frame::pass::{Commands, Domain, DrawTargets, InitialContents, Pass, Program, Programs};
use crate::frame::resource::Resource::{
    Attributes, Behind, Boxes, Coverage, EdgeTiles, Image, IncompleteFrame, ScreenClips, Splats, Sums0,
    Sums1, Visibility,
};
use crate::frame::variant::Variant;
use crate::vk::shaders::{
    BEHIND_COMPUTE, BEHIND_FRAGMENT, BEHIND_MIX_COMPUTE, BEHIND_NEAREST_SAMPLES_FRAGMENT,
    BEHIND_SLICES_COMPUTE, BEHIND_SUBGROUPS_COMPUTE, BEHIND_SUBGROUPS_SLICES_COMPUTE, BEHIND_VERTEX,
    constant,
};
use crate::vk::{Blend, DepthTest, Topology};

/// One workgroup per tile with edges; of all tiles, where the passes of `surface` run separately.
pub static COMPUTE: Pass = Pass {
    name: "behind",
    reads: &[Splats, Boxes, Attributes, ScreenClips, Visibility, Coverage],
    writes: &[Image, EdgeTiles, IncompleteFrame],
    clears: &[],
    programs: Programs::OfFrame(tile_programs),
    commands: Commands::Dispatches,
};

fn tile_programs(variant: &Variant) -> Vec<Program> {
    let domain = if variant.split { Domain::WholeTiles } else { Domain::EdgeTiles };
    let programs = tiles(variant, [&BEHIND_COMPUTE, &BEHIND_SUBGROUPS_COMPUTE]).into_iter();
    let constants = [(constant::MIXED, true), (constant::SPLIT, variant.split), (constant::SLICED, false)];
    let with = |program: Program| {
        constants.into_iter().fold(program, |program, (id, value)| program.with(id, value))
    };
    programs.map(|program| Program { domain, ..with(program) }).collect()
}

/// One workgroup per tile and slice: marks the samples of the nearest surface.
pub static SLICED_SAMPLES: Pass = sliced(|variant| stage(variant, 0));

/// The same, for the depths of the surface behind.
pub static SLICED_DEPTHS: Pass = sliced(|variant| stage(variant, 1));

/// The same, for its sums; the last slice mixes both surfaces.
pub static SLICED_ATTRIBUTES: Pass = sliced(|variant| stage(variant, 2));

const fn sliced(programs: fn(&Variant) -> Vec<Program>) -> Pass {
    Pass {
        name: "behind",
        reads: &[Splats, Boxes, Attributes, ScreenClips, Visibility],
        writes: &[Coverage, Behind, Sums0, Sums1, Image, IncompleteFrame],
        clears: &[],
        programs: Programs::OfFrame(programs),
        commands: Commands::Dispatches,
    }
}

/// Programs of a stage of `behind.glsl`.
fn stage(variant: &Variant, stage: u32) -> Vec<Program> {
    let programs = tiles(variant, [&BEHIND_SLICES_COMPUTE, &BEHIND_SUBGROUPS_SLICES_COMPUTE]).into_iter();
    programs.map(|program| program.with(constant::MIXED, true).with(constant::STAGE, stage)).collect()
}

/// Splat triangles that mark the samples of the nearest surface; they leave the depths empty.
pub static RASTER_SAMPLES: Pass = Pass {
    name: "behind",
    reads: &[Splats, ScreenClips, Visibility],
    writes: &[Coverage],
    clears: &[],
    programs: Programs::OfScene(|_| {
        vec![Program::draw([&BEHIND_VERTEX, &BEHIND_NEAREST_SAMPLES_FRAGMENT], Domain::SplatTriangles)]
    }),
    commands: Commands::Draws(DEPTH),
};

/// Splat triangles with a depth test, of splats that cover samples which the nearest surface leaves free.
pub static RASTER_DEPTHS: Pass = Pass {
    name: "behind",
    reads: &[Splats, ScreenClips, Visibility],
    writes: &[Coverage],
    clears: &[],
    programs: Programs::OfScene(|_| {
        vec![Program::draw([&BEHIND_VERTEX, &BEHIND_FRAGMENT], Domain::SplatTriangles)]
    }),
    commands: Commands::Draws(DEPTH),
};

/// One invocation per pixel, which mixes both surfaces.
pub static RASTER_MIX: Pass = Pass {
    name: "behind",
    reads: &[Behind, Coverage, Sums0, Sums1],
    writes: &[Image],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&BEHIND_MIX_COMPUTE, Domain::Pixels)]),
    commands: Commands::Dispatches,
};

/// Depth alone.
const DEPTH: DrawTargets = DrawTargets {
    colours: &[],
    depth: Some((Behind, InitialContents::Cleared)),
    topology: Topology::Triangles,
    test: DepthTest::Nearest,
    blend: Blend::Replace,
};
