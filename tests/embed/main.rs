//! Tests of embedding, with small renderers as hosts.
#![allow(unsafe_code, reason = "a host speaks Vulkan itself")]

mod barriers;
mod buffers;
mod call_depth;
mod clusters;
mod compare;
mod composite;
mod depth_shading;
mod depth_shading_refused;
mod finish;
mod fixture;
#[path = "../../tools/hosts/host/mod.rs"]
mod host;
mod hosts;
mod inputs;
mod instances;
mod levels;
mod live;
mod memory;
mod native;
mod native_depth;
mod native_live;
mod native_refused;
mod native_rig;
mod outlines;
mod pipelines;
mod raw_buffer;
mod reports;
mod rig;
#[path = "../support/mod.rs"]
mod support;
mod updates;
mod views;

use ash::vk;

/// Types that hosts may share among threads, and move between them.
const _: () = {
    const fn shared<T: Send + Sync>() {}
    shared::<surfel::embed::DepthShading>();
    shared::<surfel::embed::Renderer>();
    shared::<surfel::embed::native::Renderer>();
    shared::<surfel::Scene>();
};

const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const ONE: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_1;
const FOUR: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_4;
