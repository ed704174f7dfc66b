//! Project: surfels, lines and triangles → the nearest point of each pixel (marroquim2008 §3.1, §4, §5; `project.glsl`, `points.glsl`).
//!
//! Surfels are compared by atomic minima of distance and number, as lines and triangles are, or drawn as points of one pixel with a depth test.

use crate::frame::pass::{Commands, Over, Pass, Program, Programs, Start, Targets};
use crate::frame::resource::Resource::{Counts, LargeTriangles, Nearest, NearestDepth, NearestNumber};
use crate::frame::variant::SceneVariant;
use crate::vk::shaders::{
    POINTS_FRAGMENT, POINTS_VERTEX, PROJECT_COMPUTE, PROJECT_COUNT_ONLY_COMPUTE, PROJECT_LINES_COMPUTE,
    PROJECT_RASTER_POINTS_COMPUTE, PROJECT_TRIANGLES_COMPUTE, constant,
};
use crate::vk::{Blend, DepthTest, Topology};

/// What lines and triangles are compared by.
fn primitives(variant: &SceneVariant) -> impl Iterator<Item = Program> {
    let lines = Program::compute(&PROJECT_LINES_COMPUTE, Over::Lines);
    let triangles = Program::compute(&PROJECT_TRIANGLES_COMPUTE, Over::Triangles);
    let kinds = variant.primitives;
    kinds.lines.then_some(lines).into_iter().chain(kinds.triangles.then_some(triangles))
}

/// Surfels, lines and triangles are compared.
pub static COMPUTED: Pass = Pass {
    name: "project",
    reads: &[],
    writes: &[Nearest, LargeTriangles, Counts],
    clears: &[Nearest, LargeTriangles, Counts],
    programs: Programs::OfScene(|variant| {
        let surfels = Program::compute(&PROJECT_COMPUTE, Over::Surfels);
        std::iter::once(surfels).chain(primitives(variant)).collect()
    }),
    commands: Commands::Dispatches,
};

/// Triangles of many pixels, which were listed.
pub static LARGE: Pass = Pass {
    name: "project",
    reads: &[],
    writes: &[Nearest, LargeTriangles],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let large = Program::compute(&PROJECT_TRIANGLES_COMPUTE, Over::LargeTriangles);
        let large = large.with(constant::LARGE_TRIANGLES, true);
        variant.primitives.triangles.then_some(large).into_iter().collect()
    }),
    commands: Commands::Dispatches,
};

/// Surfels are drawn.
pub static DRAWN: Pass = Pass {
    name: "project",
    reads: &[],
    writes: &[],
    clears: &[],
    programs: Programs::OfScene(|_| vec![Program::draw([&POINTS_VERTEX, &POINTS_FRAGMENT], Over::Points)]),
    commands: Commands::Draws(Targets {
        colours: &[(NearestNumber, Start::Cleared)],
        depth: Some((NearestDepth, Start::Cleared)),
        topology: Topology::Points,
        test: DepthTest::Nearest,
        blend: Blend::Replace,
    }),
};

/// Surfels that were drawn → what lines and triangles are compared with.
pub static HANDED_OVER: Pass = Pass {
    name: "project",
    reads: &[NearestDepth, NearestNumber],
    writes: &[Nearest],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&PROJECT_RASTER_POINTS_COMPUTE, Over::Pixels)]),
    commands: Commands::Dispatches,
};

/// Lines and triangles, beside surfels that were drawn; these are counted.
pub static BESIDE_DRAWN: Pass = Pass {
    name: "project",
    reads: &[],
    writes: &[Nearest, LargeTriangles, Counts],
    clears: &[LargeTriangles, Counts],
    programs: Programs::OfScene(|variant| {
        let counted = Program::compute(&PROJECT_COUNT_ONLY_COMPUTE, Over::Surfels);
        variant.frame.count.then_some(counted).into_iter().chain(primitives(variant)).collect()
    }),
    commands: Commands::Dispatches,
};
