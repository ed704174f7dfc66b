//! Fetch: nearest point of each pixel → its sample (marroquim2008 §3.1; `fetch.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{Nearest, NearestId, OccupiedTiles, Pulled};
use crate::vk::shaders::{
    FETCH_COMPUTE, FETCH_LINES_COMPUTE, FETCH_RASTER_POINTS_COMPUTE, FETCH_TRIANGLES_COMPUTE,
};

/// One invocation per pixel of occupied tiles, for each chunk of a scene. Chunks write disjoint pixels, so their order is free. With lines or
/// triangles, rasterized points have been copied to the nearest points.
pub static FETCH: Pass = Pass {
    name: "fetch",
    reads: &[Nearest, NearestId, OccupiedTiles],
    writes: &[Pulled],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        let surfels =
            if variant.frame.has_compute_points() { &FETCH_COMPUTE } else { &FETCH_RASTER_POINTS_COMPUTE };
        let lines = Program::compute(&FETCH_LINES_COMPUTE, Domain::PixelsOfLines);
        let triangles = Program::compute(&FETCH_TRIANGLES_COMPUTE, Domain::PixelsOfTriangles);
        let kinds = variant.primitives;
        let surfels = std::iter::once(Program::compute(surfels, Domain::PixelsOfSurfels));
        surfels.chain(kinds.lines.then_some(lines)).chain(kinds.triangles.then_some(triangles)).collect()
    }),
    commands: Commands::Dispatches,
};
