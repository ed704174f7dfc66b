//! Attribute: splats within ε of the nearest surface → weighted sums (zwicker2004 §6, second pass; `attribute.glsl`).

use super::tiles;
use crate::frame::pass::{Commands, Over, Pass, Program, Programs, Start, Targets};
use crate::frame::resource::Resource::{
    Attributes, Boxes, IncompleteFrame, ScreenClips, Splats, Sums0, Sums1, Visibility,
};
use crate::vk::shaders::{
    ATTRIBUTE_CLIP_LINES_FRAGMENT, ATTRIBUTE_CLIP_LINES_VERTEX, ATTRIBUTE_COMPUTE, ATTRIBUTE_FRAGMENT,
    ATTRIBUTE_SUBGROUPS_COMPUTE, ATTRIBUTE_VERTEX,
};
use crate::vk::{Blend, DepthTest, Topology};

/// A workgroup a tile.
pub static COMPUTED: Pass = Pass {
    name: "attribute",
    reads: &[Splats, Boxes, Attributes, ScreenClips, Visibility],
    writes: &[Sums0, Sums1, IncompleteFrame],
    clears: &[],
    programs: Programs::OfFrame(|variant| tiles(variant, [&ATTRIBUTE_COMPUTE, &ATTRIBUTE_SUBGROUPS_COMPUTE])),
    commands: Commands::Dispatches,
};

/// Draws with additive blending.
pub static DRAWN: Pass = Pass {
    name: "attribute",
    reads: &[Splats, ScreenClips],
    writes: &[],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let modules = match variant.clips {
            true => [&ATTRIBUTE_CLIP_LINES_VERTEX, &ATTRIBUTE_CLIP_LINES_FRAGMENT],
            false => [&ATTRIBUTE_VERTEX, &ATTRIBUTE_FRAGMENT],
        };
        vec![Program::draw(modules, Over::SplatTriangles)]
    }),
    commands: Commands::Draws(Targets {
        colours: &[(Sums0, Start::Cleared), (Sums1, Start::Cleared)],
        depth: Some((Visibility, Start::Tested)),
        topology: Topology::Triangles,
        test: DepthTest::NotBehind,
        blend: Blend::Add,
    }),
};
