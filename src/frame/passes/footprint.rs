//! Footprint: surfels → splats, culled and counted (zwicker2004 §4; `footprint.glsl`).

use crate::frame::pass::{Commands, Over, Pass, Program, Programs};
use crate::frame::resource::Resource::{Counts, LargeSplats, ScreenClips, Splats};
use crate::vk::shaders::{FOOTPRINT_COMPUTE, constant};

/// Surfels of each scene → its splats, and their counts.
pub static FOOTPRINT: Pass = Pass {
    name: "footprint",
    reads: &[],
    writes: &[Splats, LargeSplats, ScreenClips, Counts],
    clears: &[LargeSplats, Counts],
    programs: Programs::OfScene(|_| vec![Program::compute(&FOOTPRINT_COMPUTE, Over::Surfels)]),
    commands: Commands::Dispatches,
};

/// The same of discs that are moved away by ε along the camera's axis, which visibility wants where ε is measured along that; they are not
/// counted.
pub static MOVED: Pass = Pass {
    name: "footprint",
    reads: &[],
    writes: &[Splats, LargeSplats, ScreenClips],
    clears: &[LargeSplats],
    programs: Programs::OfScene(|_| {
        let program = Program::compute(&FOOTPRINT_COMPUTE, Over::Surfels);
        vec![program.with(constant::MOVED, true).with(constant::COUNT, false)]
    }),
    commands: Commands::Dispatches,
};
