//! Shade: the final level 0 → picture, normal, depth (marroquim2008 §3.4; `shade.glsl`).

use crate::frame::pass::{Commands, Over, Pass, Program, Programs};
use crate::frame::resource::Resource::{Picture, Pushed};
use crate::vk::shaders::{SHADE_COMPUTE, SHADE_LOOKUPS_COMPUTE};

/// An invocation a pixel, which looks colours up in a texture, or materials by the numbers of points, where there are such.
pub static SHADE: Pass = Pass {
    name: "shade",
    reads: &[Pushed],
    writes: &[Picture],
    clears: &[],
    programs: Programs::OfFrame(|variant| {
        let module = match variant.texture.is_some() || variant.materials {
            true => &SHADE_LOOKUPS_COMPUTE,
            false => &SHADE_COMPUTE,
        };
        vec![Program::compute(module, Over::Pixels)]
    }),
    commands: Commands::Dispatches,
};
