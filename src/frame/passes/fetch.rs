//! Fetch: the nearest point of each pixel → what it is (marroquim2008 §3.1; `fetch.glsl`).

use crate::frame::pass::{Commands, Over, Pass, Program, Programs};
use crate::frame::resource::Resource::{Nearest, NearestNumber, Pulled};
use crate::vk::shaders::{
    FETCH_COMPUTE, FETCH_LINES_COMPUTE, FETCH_RASTER_POINTS_COMPUTE, FETCH_TRIANGLES_COMPUTE,
};

/// An invocation a pixel, for each part of a scene: the pixels of one's points are not another's, so that their order does not matter. The first
/// part of the first scene clears what nobody's are. Where lines or triangles are computed, drawn points are among what they were compared with.
pub static FETCH: Pass = Pass {
    name: "fetch",
    reads: &[Nearest, NearestNumber],
    writes: &[Pulled],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let surfels = match variant.frame.computes_points() {
            true => &FETCH_COMPUTE,
            false => &FETCH_RASTER_POINTS_COMPUTE,
        };
        let lines = Program::compute(&FETCH_LINES_COMPUTE, Over::PixelsOfLines);
        let triangles = Program::compute(&FETCH_TRIANGLES_COMPUTE, Over::PixelsOfTriangles);
        let kinds = variant.primitives;
        let surfels = std::iter::once(Program::compute(surfels, Over::PixelsOfSurfels));
        surfels.chain(kinds.lines.then_some(lines)).chain(kinds.triangles.then_some(triangles)).collect()
    }),
    commands: Commands::Dispatches,
};

/// What is done instead in a frame without scenes.
pub static EMPTY: Pass = Pass {
    name: "fetch",
    reads: &[],
    writes: &[Pulled],
    clears: &[Pulled],
    programs: Programs::None,
    commands: Commands::Dispatches,
};
