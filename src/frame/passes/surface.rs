//! Surface: splats → picture, normal, depth: visibility, attribute and normalize tile by tile, in one dispatch (zwicker2004 §6; `surface.glsl`).

use super::tiles;
use crate::frame::pass::{Commands, Pass, Programs};
use crate::frame::resource::Resource::{
    Attributes, Boxes, Depth, Image, IncompleteFrame, Normal, ScreenClips, Splats, Visibility,
};
use crate::vk::shaders::{SURFACE_COMPUTE, SURFACE_SUBGROUPS_COMPUTE};

/// One workgroup per tile.
pub static SURFACE: Pass = Pass {
    name: "surface",
    reads: &[Splats, Boxes, Attributes, ScreenClips, Visibility],
    writes: &[Image, Normal, Depth, IncompleteFrame],
    clears: &[],
    programs: Programs::OfFrame(|variant| tiles(variant, [&SURFACE_COMPUTE, &SURFACE_SUBGROUPS_COMPUTE])),
    commands: Commands::Dispatches,
};
