//! Normalize: weighted sums → picture, normal, depth (zwicker2004 §6, third pass; `normalize.glsl`).

use crate::frame::pass::{Commands, Domain, DrawTargets, InitialContents, Pass, Program, Programs};
use crate::frame::resource::Resource::{Coverage, Depth, Image, Normal, Sums0, Sums1, Visibility};
use crate::vk::shaders::{
    NORMALIZE_COMPUTE, NORMALIZE_COVERAGE_COMPUTE, NORMALIZE_COVERAGE_FRAGMENT, NORMALIZE_COVERAGE_VERTEX,
    NORMALIZE_FRAGMENT, NORMALIZE_SUBPASS_COVERAGE_FRAGMENT, NORMALIZE_SUBPASS_FRAGMENT, NORMALIZE_VERTEX,
};
use crate::vk::{Blend, DepthTest, Topology};

/// One invocation per pixel.
pub static COMPUTE: Pass = Pass {
    name: "normalize",
    reads: &[Visibility, Sums0, Sums1, Coverage],
    writes: &[Image, Normal, Depth],
    clears: &[],
    programs: Programs::OfFrame(|variant| {
        let module = if variant.coverage { &NORMALIZE_COVERAGE_COMPUTE } else { &NORMALIZE_COMPUTE };
        vec![Program::compute(module, Domain::Pixels)]
    }),
    commands: Commands::Dispatches,
};

/// A full-screen draw.
pub static RASTER: Pass = Pass {
    name: "normalize",
    reads: &[Visibility, Sums0, Sums1, Coverage],
    writes: &[],
    clears: &[],
    programs: Programs::OfFrame(|variant| {
        let modules = if variant.coverage {
            [&NORMALIZE_COVERAGE_VERTEX, &NORMALIZE_COVERAGE_FRAGMENT]
        } else {
            [&NORMALIZE_VERTEX, &NORMALIZE_FRAGMENT]
        };
        vec![Program::draw(modules, Domain::FullScreen)]
    }),
    commands: Commands::Draws(DrawTargets {
        colours: &[
            (Image, InitialContents::Overwritten),
            (Normal, InitialContents::Overwritten),
            (Depth, InitialContents::Overwritten),
        ],
        depth: None,
        topology: Topology::Triangles,
        test: DepthTest::None,
        blend: Blend::Replace,
    }),
};

/// A full-screen draw in a subpass of a host, to the host's colour and depth attachments.
pub static IN_SUBPASS: Pass = Pass {
    name: "normalize",
    reads: &[Visibility, Sums0, Sums1, Coverage],
    writes: &[],
    clears: &[],
    programs: Programs::OfFrame(|variant| {
        let fragment =
            if variant.coverage { &NORMALIZE_SUBPASS_COVERAGE_FRAGMENT } else { &NORMALIZE_SUBPASS_FRAGMENT };
        vec![Program::draw([&NORMALIZE_VERTEX, fragment], Domain::FullScreen)]
    }),
    commands: Commands::Draws(DrawTargets {
        colours: &[],
        depth: None,
        topology: Topology::Triangles,
        test: DepthTest::None,
        blend: Blend::Over,
    }),
};
