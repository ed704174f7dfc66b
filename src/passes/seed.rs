//! Seed: the depth of a host's surfaces → what visibility starts from, in a subpass of the host (`seed.glsl`).

use crate::error::Result;
use crate::vk::shaders::{self, constant, layout};
use crate::vk::{
    Binding, Constants, DepthTest, DescriptorSet, Device, DrawPipeline, Draws, HostDepth, SetLayout, Within,
};
use ash::vk::{DescriptorType, ShaderStageFlags};
use std::sync::Arc;

/// The seed pass.
pub struct Seed {
    layout: SetLayout,
    pipeline: DrawPipeline,
}

impl Seed {
    /// The pass, drawn `within` a pass of a host whose depth has so many samples a pixel.
    pub fn new(device: &Arc<Device>, perspective: bool, samples: u32, within: &Within<'_>) -> Result<Self> {
        let layout =
            SetLayout::new(device, &[(DescriptorType::INPUT_ATTACHMENT, ShaderStageFlags::FRAGMENT)])?;
        let fragment = match samples {
            1 => &shaders::SEED_FRAGMENT,
            _ => &shaders::SEED_MULTISAMPLED_FRAGMENT,
        };
        let constants = Constants::default()
            .with(constant::PERSPECTIVE, perspective)
            .with(constant::HOST_SAMPLES, samples);
        let (code, push) = ([&shaders::SEED_VERTEX, fragment], size_of::<layout::Seed>() as u32);
        let depth = DepthTest::Always;
        let pipeline = DrawPipeline::of_host(device, &[&layout], code, &constants, within, depth, push)?;
        Ok(Self { layout, pipeline })
    }

    /// The pass's view of the host's depth.
    pub fn view(&self, device: &Arc<Device>, depth: HostDepth) -> Result<DescriptorSet> {
        DescriptorSet::new(device, &self.layout, &[Binding::HostDepth(depth)])
    }

    /// The host's depth → the subpass's depth.
    pub fn draw(&self, draws: &mut Draws<'_>, view: &DescriptorSet, host: &layout::Seed) {
        draws.draw(&self.pipeline, &[view], host, 3);
    }
}
