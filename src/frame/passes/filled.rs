//! Filled: occupied tiles, final samples of level 4 → list of the tiles that push may fill on the finest levels (`filled.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs, StepContext};
use crate::frame::recording::grid_over;
use crate::frame::resource::Resource::{FilledTiles, OccupiedTiles, Pushed};
use crate::frame::tile_list::TILE_LEVEL;
use crate::vk::shaders::FILLED_COMPUTE;
use crate::vk::{Access, Recorder};

/// One invocation per tile.
pub static FILLED: Pass = Pass {
    name: "filled",
    reads: &[OccupiedTiles, Pushed],
    writes: &[FilledTiles],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::compute(&FILLED_COMPUTE, Domain::CoarseLevels)]),
    commands: Commands::Steps(record),
};

fn record(steps: &StepContext<'_>, rec: &mut Recorder<'_>) {
    let StepContext { pipeline: Some(pipeline), frame, .. } = steps else { return };
    let Some(pyramids) = &frame.targets.pyramids else { return };
    let [_, last] = pyramids.storage.push(TILE_LEVEL);
    let lists = [(OccupiedTiles, Access::COMPUTE_READ), (FilledTiles, Access::COMPUTE_WRITE)];
    let read = pyramids.pyramids.iter().flat_map(|pyramid| pyramid.with(Access::COMPUTE_READ));
    let mut enc = rec.pass(FILLED.name, &frame.uses(&lists).into_iter().chain(read).collect::<Vec<_>>());
    enc.dispatch(
        pipeline,
        &steps.sets_to_read(last),
        &pyramids.final_step(TILE_LEVEL),
        grid_over(frame.targets.pyramid_tiles()),
    );
}
