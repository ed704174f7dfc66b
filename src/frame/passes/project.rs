//! Project: surfels, lines and triangles → the nearest point of each pixel (marroquim2008 §3.1, §4, §5; `project.glsl`, `points.glsl`).
//!
//! Compute path: atomic minima of distance and id. Raster path: surfels are points of one pixel with a depth test. Lines and triangles
//! always take the compute path.

use crate::frame::pass::{Commands, Domain, DrawTargets, InitialContents, Pass, Program, Programs};
use crate::frame::resource::Resource::{
    Counts, LargeTriangles, Nearest, NearestDepth, NearestId, VisibleClusters,
};
use crate::frame::scene_variant::SceneVariant;
use crate::vk::shaders::{
    POINTS_FRAGMENT, POINTS_VERTEX, PROJECT_COMPUTE, PROJECT_COUNT_ONLY_COMPUTE, PROJECT_LINES_COMPUTE,
    PROJECT_RASTER_POINTS_COMPUTE, PROJECT_TRIANGLES_COMPUTE, constant,
};
use crate::vk::{Blend, DepthTest, Topology};

/// Programs of lines and triangles.
fn primitives(variant: &SceneVariant) -> impl Iterator<Item = Program> {
    let lines = Program::compute(&PROJECT_LINES_COMPUTE, Domain::Lines);
    let triangles = Program::compute(&PROJECT_TRIANGLES_COMPUTE, Domain::Triangles);
    let kinds = variant.primitives;
    kinds.lines.then_some(lines).into_iter().chain(kinds.triangles.then_some(triangles))
}

/// Compute path: surfels, lines and triangles.
pub static COMPUTE: Pass = Pass {
    name: "project",
    reads: &[VisibleClusters],
    writes: &[Nearest, LargeTriangles, Counts],
    clears: &[Nearest, LargeTriangles],
    programs: Programs::OfScene(|variant| {
        let domain = if variant.frame.clusters { Domain::VisibleClusters } else { Domain::Surfels };
        let surfels = Program::compute(&PROJECT_COMPUTE, domain);
        std::iter::once(surfels).chain(primitives(variant)).collect()
    }),
    commands: Commands::Dispatches,
};

/// Large triangles, which the previous pass listed.
pub static LARGE: Pass = Pass {
    name: "project",
    reads: &[],
    writes: &[Nearest, LargeTriangles],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let large = Program::compute(&PROJECT_TRIANGLES_COMPUTE, Domain::LargeTriangles);
        let large = large.with(constant::LARGE_TRIANGLES, true);
        variant.primitives.triangles.then_some(large).into_iter().collect()
    }),
    commands: Commands::Dispatches,
};

/// Raster path: surfels as points.
pub static RASTER: Pass = Pass {
    name: "project",
    reads: &[],
    writes: &[],
    clears: &[],
    programs: Programs::OfScene(|_| vec![Program::draw([&POINTS_VERTEX, &POINTS_FRAGMENT], Domain::Points)]),
    commands: Commands::Draws(DrawTargets {
        colours: &[(NearestId, InitialContents::Cleared)],
        depth: Some((NearestDepth, InitialContents::Cleared)),
        topology: Topology::Points,
        test: DepthTest::Nearest,
        blend: Blend::Replace,
    }),
};

/// Copies rasterized points to the nearest points that lines and triangles update.
pub static COPY_RASTER_POINTS: Pass = Pass {
    name: "project",
    reads: &[NearestDepth, NearestId],
    writes: &[Nearest],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&PROJECT_RASTER_POINTS_COMPUTE, Domain::Pixels)]),
    commands: Commands::Dispatches,
};

/// Lines and triangles after rasterized surfels, which are counted here.
pub static PRIMITIVES: Pass = Pass {
    name: "project",
    reads: &[],
    writes: &[Nearest, LargeTriangles, Counts],
    clears: &[LargeTriangles],
    programs: Programs::OfScene(|variant| {
        let counted = Program::compute(&PROJECT_COUNT_ONLY_COMPUTE, Domain::Surfels);
        variant.frame.count.then_some(counted).into_iter().chain(primitives(variant)).collect()
    }),
    commands: Commands::Dispatches,
};
