//! Occupied: nearest points → list of the pyramid tiles that have any, for dispatches over these (`occupied.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{
    Depth, FilledTiles, Id, Image, Nearest, NearestId, Normal, OccupiedTiles, Pulled, Pushed,
};
use crate::vk::shaders::{OCCUPIED_COMPUTE, OCCUPIED_RASTER_POINTS_COMPUTE};

/// One invocation per row of pixels of a tile. Before it, all is cleared at once that later passes write in listed tiles alone.
pub static OCCUPIED: Pass = Pass {
    name: "occupied",
    reads: &[Nearest, NearestId],
    writes: &[OccupiedTiles],
    clears: &[OccupiedTiles, FilledTiles, Pulled, Pushed, Image, Normal, Depth, Id],
    programs: Programs::OfFrame(|variant| {
        let modules = [&OCCUPIED_RASTER_POINTS_COMPUTE, &OCCUPIED_COMPUTE];
        let module = modules[usize::from(variant.has_compute_points())];
        vec![Program::compute(module, Domain::RowsOfPyramidTiles)]
    }),
    commands: Commands::Dispatches,
};
