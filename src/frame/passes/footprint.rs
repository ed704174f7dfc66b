//! Footprint: surfels → splats, culled and counted (zwicker2004 §4; `footprint.glsl`).

use crate::frame::pass::{Commands, Over, Pass, Program, Programs};
use crate::frame::resource::Resource::{Attributes, Boxes, Counts, ScreenClips, Splats};
use crate::frame::variant::SceneVariant;
use crate::vk::shaders::{FOOTPRINT_COMPUTE, FOOTPRINT_TILES_COMPUTE, constant};

/// An invocation a surfel; for tiles, whose lists of splats have no gaps, an invocation for each that there is room for.
fn footprint(variant: &SceneVariant) -> Program {
    match variant.frame.is_tiled() {
        true => Program::compute(&FOOTPRINT_TILES_COMPUTE, Over::Slots),
        false => Program::compute(&FOOTPRINT_COMPUTE, Over::Surfels),
    }
}

/// Surfels of each scene → its splats, and their counts.
pub static FOOTPRINT: Pass = Pass {
    name: "footprint",
    reads: &[],
    writes: &[Splats, Boxes, Attributes, ScreenClips, Counts],
    clears: &[Counts],
    programs: Programs::OfScene(|variant| vec![footprint(variant)]),
    commands: Commands::Dispatches,
};

/// The same of discs that are moved away by ε along the camera's axis, which visibility wants where ε is measured along that; they are not
/// counted.
pub static MOVED: Pass = Pass {
    name: "footprint",
    reads: &[],
    writes: &[Splats, Boxes, Attributes, ScreenClips],
    clears: &[],
    programs: Programs::OfScene(|variant| {
        vec![footprint(variant).with(constant::MOVED, true).with(constant::COUNT, false)]
    }),
    commands: Commands::Dispatches,
};
