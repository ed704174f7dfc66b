//! Seed: depth of a host's surfaces → initial visibility, in a subpass of the host (`seed.glsl`).

use crate::frame::pass::{Commands, Domain, DrawTargets, InitialContents, Pass, Program, Programs};
use crate::frame::resource::Resource::{HostDepth, Visibility};
use crate::vk::shaders::{SEED_FRAGMENT, SEED_VERTEX};
use crate::vk::{Blend, DepthTest, Topology};

/// A full-screen draw.
pub static SEED: Pass = Pass {
    name: "seed",
    reads: &[HostDepth],
    writes: &[],
    clears: &[],
    programs: Programs::OfFrame(|_| vec![Program::draw([&SEED_VERTEX, &SEED_FRAGMENT], Domain::FullScreen)]),
    commands: Commands::Draws(DrawTargets {
        colours: &[],
        depth: Some((Visibility, InitialContents::Cleared)),
        topology: Topology::Triangles,
        test: DepthTest::Always,
        blend: Blend::Replace,
    }),
};
