//! Seed: the depth of a host's surfaces → what visibility starts from, in a subpass of the host (`seed.glsl`).

use crate::frame::pass::{Commands, Over, Pass, Program, Programs, Start, Targets};
use crate::frame::resource::Resource::{HostDepth, Visibility};
use crate::vk::shaders::{SEED_FRAGMENT, SEED_VERTEX};
use crate::vk::{Blend, DepthTest, Topology};

/// A draw over the whole picture.
pub static SEED: Pass = Pass {
    name: "seed",
    reads: &[HostDepth],
    writes: &[],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::draw([&SEED_VERTEX, &SEED_FRAGMENT], Over::FullScreen)]),
    commands: Commands::Draws(Targets {
        colours: &[],
        depth: Some((Visibility, Start::Cleared)),
        topology: Topology::Triangles,
        test: DepthTest::Always,
        blend: Blend::Replace,
    }),
};
