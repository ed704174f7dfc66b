//! Shade: the final level 0 → picture, normal, depth (marroquim2008 §3.4; `shade.glsl`).

use crate::frame::pass::{Commands, Domain, Pass, Program, Programs};
use crate::frame::resource::Resource::{Depth, Id, Image, Normal, Pushed};
use crate::vk::shaders::{
    SHADE_COMPUTE, SHADE_LOOKUPS_COMPUTE, SHADE_LOOKUPS_STORE_IDS_COMPUTE, SHADE_STORE_IDS_COMPUTE,
};

/// One invocation per pixel; with a texture or materials, the variant that looks these up.
pub static SHADE: Pass = Pass {
    name: "shade",
    reads: &[Pushed],
    writes: &[Image, Normal, Depth, Id],
    clears: &[],
    programs: Programs::OfFrame(|variant| {
        let module = match (variant.texture.is_some() || variant.materials, variant.outputs.id) {
            (false, false) => &SHADE_COMPUTE,
            (false, true) => &SHADE_STORE_IDS_COMPUTE,
            (true, false) => &SHADE_LOOKUPS_COMPUTE,
            (true, true) => &SHADE_LOOKUPS_STORE_IDS_COMPUTE,
        };
        vec![Program::compute(module, Domain::Pixels)]
    }),
    commands: Commands::Dispatches,
};
