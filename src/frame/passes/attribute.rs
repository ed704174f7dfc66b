//! Attribute: splats within ε of the nearest surface → weighted sums (zwicker2004 §6, second pass; `attribute.glsl`).

use super::tiles;
use crate::frame::pass::{Commands, Domain, DrawTargets, InitialContents, Pass, Program, Programs};
use crate::frame::resource::Resource::{
    Attributes, Behind, Boxes, IncompleteFrame, ScreenClips, Splats, Sums0, Sums1, Visibility,
};
use crate::vk::shaders::{
    ATTRIBUTE_BEHIND_CLIP_LINES_FRAGMENT, ATTRIBUTE_BEHIND_FRAGMENT, ATTRIBUTE_CLIP_LINES_FRAGMENT,
    ATTRIBUTE_CLIP_LINES_VERTEX, ATTRIBUTE_COMPUTE, ATTRIBUTE_FRAGMENT, ATTRIBUTE_SUBGROUPS_COMPUTE,
    ATTRIBUTE_VERTEX,
};
use crate::vk::{Blend, DepthTest, Topology};

/// One workgroup per tile.
pub static COMPUTE: Pass = Pass {
    name: "attribute",
    reads: &[Splats, Boxes, Attributes, ScreenClips, Visibility],
    writes: &[Sums0, Sums1, IncompleteFrame],
    clears: &[],
    programs: Programs::OfFrame(|variant| tiles(variant, [&ATTRIBUTE_COMPUTE, &ATTRIBUTE_SUBGROUPS_COMPUTE])),
    commands: Commands::Dispatches,
};

/// Splat triangles with additive blending.
pub static RASTER: Pass = Pass {
    name: "attribute",
    reads: &[Splats, ScreenClips],
    writes: &[],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let modules = if variant.clips {
            [&ATTRIBUTE_CLIP_LINES_VERTEX, &ATTRIBUTE_CLIP_LINES_FRAGMENT]
        } else {
            [&ATTRIBUTE_VERTEX, &ATTRIBUTE_FRAGMENT]
        };
        vec![Program::draw(modules, Domain::SplatTriangles)]
    }),
    commands: Commands::Draws(DrawTargets {
        colours: &[(Sums0, InitialContents::Cleared), (Sums1, InitialContents::Cleared)],
        depth: Some((Visibility, InitialContents::Tested)),
        topology: Topology::Triangles,
        test: DepthTest::NotBehind,
        blend: Blend::Add,
    }),
};

/// The same for the surface behind, within the depths of pass behind.
pub static RASTER_BEHIND: Pass = Pass {
    name: "attribute",
    reads: &[Splats, ScreenClips, Visibility],
    writes: &[],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let modules = if variant.clips {
            [&ATTRIBUTE_CLIP_LINES_VERTEX, &ATTRIBUTE_BEHIND_CLIP_LINES_FRAGMENT]
        } else {
            [&ATTRIBUTE_VERTEX, &ATTRIBUTE_BEHIND_FRAGMENT]
        };
        vec![Program::draw(modules, Domain::SplatTriangles)]
    }),
    commands: Commands::Draws(DrawTargets {
        colours: &[(Sums0, InitialContents::Cleared), (Sums1, InitialContents::Cleared)],
        depth: Some((Behind, InitialContents::Tested)),
        topology: Topology::Triangles,
        test: DepthTest::NotBehind,
        blend: Blend::Add,
    }),
};
