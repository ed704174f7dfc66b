//! Normalize: weighted sums → picture, normal, depth (zwicker2004 §6, third pass; `normalize.glsl`).

use crate::frame::pass::{Commands, Over, Pass, Program, Programs, Start, Targets};
use crate::frame::resource::Resource::{Coverage, Depth, Image, Normal, Sums0, Sums1, Visibility};
use crate::vk::shaders::{
    NORMALIZE_COMPUTE, NORMALIZE_COVERAGE_COMPUTE, NORMALIZE_COVERAGE_FRAGMENT, NORMALIZE_COVERAGE_VERTEX,
    NORMALIZE_FRAGMENT, NORMALIZE_SUBPASS_COVERAGE_FRAGMENT, NORMALIZE_SUBPASS_FRAGMENT, NORMALIZE_VERTEX,
};
use crate::vk::{Blend, DepthTest, Topology};

/// An invocation a pixel.
pub static COMPUTED: Pass = Pass {
    name: "normalize",
    reads: &[Visibility, Sums0, Sums1, Coverage],
    writes: &[Image, Normal, Depth],
    clears: &[],
    programs: Programs::OfFrame(|variant| {
        let module = match variant.coverage {
            false => &NORMALIZE_COMPUTE,
            true => &NORMALIZE_COVERAGE_COMPUTE,
        };
        vec![Program::compute(module, Over::Pixels)]
    }),
    commands: Commands::Dispatches,
};

/// A draw over the whole picture.
pub static DRAWN: Pass = Pass {
    name: "normalize",
    reads: &[Visibility, Sums0, Sums1, Coverage],
    writes: &[],
    clears: &[],
    programs: Programs::OfFrame(|variant| {
        let modules = match variant.coverage {
            false => [&NORMALIZE_VERTEX, &NORMALIZE_FRAGMENT],
            true => [&NORMALIZE_COVERAGE_VERTEX, &NORMALIZE_COVERAGE_FRAGMENT],
        };
        vec![Program::draw(modules, Over::FullScreen)]
    }),
    commands: Commands::Draws(Targets {
        colours: &[(Image, Start::Overwritten), (Normal, Start::Overwritten), (Depth, Start::Overwritten)],
        depth: None,
        topology: Topology::Triangles,
        test: DepthTest::None,
        blend: Blend::Replace,
    }),
};

/// A draw in a subpass of a host: what it draws goes to the host's colours and depth.
pub static IN_SUBPASS: Pass = Pass {
    name: "normalize",
    reads: &[Visibility, Sums0, Sums1, Coverage],
    writes: &[],
    clears: &[],
    programs: Programs::OfFrame(|variant| {
        let fragment = match variant.coverage {
            false => &NORMALIZE_SUBPASS_FRAGMENT,
            true => &NORMALIZE_SUBPASS_COVERAGE_FRAGMENT,
        };
        vec![Program::draw([&NORMALIZE_VERTEX, fragment], Over::FullScreen)]
    }),
    commands: Commands::Draws(Targets {
        colours: &[],
        depth: None,
        topology: Topology::Triangles,
        test: DepthTest::None,
        blend: Blend::Over,
    }),
};
