//! What shaders see of buffers and images.

use super::{Buffer, Device, Image, image::is_depth};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// The bindings 0, 1, … of a descriptor set: each a kind and the stages that see it.
pub struct SetLayout {
    pub(super) raw: vk::DescriptorSetLayout,
    bindings: Vec<(vk::DescriptorType, vk::ShaderStageFlags)>,
    device: Arc<Device>,
}

/// What stands at one binding.
#[derive(Clone, Copy)]
pub enum Binding<'a> {
    /// A whole uniform buffer.
    Uniform(&'a Buffer),
    /// A range of a storage buffer: offset and length, bytes.
    Storage(&'a Buffer, u64, u64),
    /// An image that the shader fetches from.
    Sampled(&'a Image),
    /// An attachment that an earlier subpass wrote, at the pixel that is drawn.
    Input(&'a Image),
    /// The same of a host's depth.
    HostDepth(HostDepth),
}

/// A host's depth as an input attachment.
#[derive(Clone, Copy, Debug)]
pub struct HostDepth(vk::ImageView);

impl HostDepth {
    /// # Safety
    /// `view` is of the depth aspect alone of an attachment of the host, and outlives the sets that it is written to.
    pub unsafe fn new(view: vk::ImageView) -> Self {
        Self(view)
    }
}

impl SetLayout {
    /// A layout with `bindings` in their order.
    pub fn new(
        device: &Arc<Device>,
        bindings: &[(vk::DescriptorType, vk::ShaderStageFlags)],
    ) -> Result<Self> {
        let raw: Vec<_> = bindings
            .iter()
            .zip(0..)
            .map(|((kind, stages), i)| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(i)
                    .descriptor_type(*kind)
                    .descriptor_count(1)
                    .stage_flags(*stages)
            })
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&raw);
        // SAFETY: `info` is valid; the layout is destroyed in `drop`.
        let raw = unsafe { device.raw.create_descriptor_set_layout(&info, None) }
            .map_err(Error::vulkan("vkCreateDescriptorSetLayout"))?;
        Ok(Self { raw, bindings: bindings.to_vec(), device: device.clone() })
    }

    /// Kind and stages of each binding.
    pub(super) fn bindings(&self) -> &[(vk::DescriptorType, vk::ShaderStageFlags)] {
        &self.bindings
    }

    /// How many storage buffers a stage sees.
    pub(super) fn storage_buffers(&self, stage: vk::ShaderStageFlags) -> u32 {
        let seen = |(kind, stages): &&(vk::DescriptorType, vk::ShaderStageFlags)| {
            *kind == vk::DescriptorType::STORAGE_BUFFER && stages.contains(stage)
        };
        self.bindings.iter().filter(seen).count() as u32
    }
}

impl Drop for SetLayout {
    fn drop(&mut self) {
        // SAFETY: layouts may go before the sets and pipelines made from them.
        unsafe { self.device.raw.destroy_descriptor_set_layout(self.raw, None) };
    }
}

/// A descriptor set, written once.
pub struct DescriptorSet {
    pub(super) raw: vk::DescriptorSet,
    pool: vk::DescriptorPool,
    kinds: Vec<vk::DescriptorType>,
    device: Arc<Device>,
}

impl DescriptorSet {
    /// A set of `layout` with one entry of `bindings` a binding. What they name must outlive the set's last use.
    pub fn new(device: &Arc<Device>, layout: &SetLayout, bindings: &[Binding<'_>]) -> Result<Self> {
        assert_eq!(layout.bindings.len(), bindings.len(), "one entry a binding");
        let kinds: Vec<_> = layout.bindings.iter().map(|(kind, _)| *kind).collect();
        let (raw, pool) = device.descriptor_pools.allocate(&device.raw, layout.raw, &kinds)?;
        let set = Self { raw, pool, kinds, device: device.clone() };
        set.write(bindings);
        Ok(set)
    }

    fn write(&self, bindings: &[Binding<'_>]) {
        for (binding, i) in bindings.iter().zip(0..) {
            let write = vk::WriteDescriptorSet::default().dst_set(self.raw).dst_binding(i);
            let buffer = |buffer: &Buffer, offset, range| {
                [vk::DescriptorBufferInfo { buffer: buffer.raw, offset, range }]
            };
            let update = |write: vk::WriteDescriptorSet<'_>| {
                // SAFETY: the set is new, so no command uses it, and the layout has this binding with this kind.
                unsafe { self.device.raw.update_descriptor_sets(&[write], &[]) }
            };
            match *binding {
                Binding::Uniform(uniform) => {
                    update(write.descriptor_type(vk::DescriptorType::UNIFORM_BUFFER).buffer_info(&buffer(
                        uniform,
                        0,
                        vk::WHOLE_SIZE,
                    )))
                }
                Binding::Storage(storage, offset, size) => update(
                    write
                        .descriptor_type(vk::DescriptorType::STORAGE_BUFFER)
                        .buffer_info(&buffer(storage, offset, size)),
                ),
                Binding::Sampled(image) => {
                    let info = seen(image.view, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL);
                    update(write.descriptor_type(vk::DescriptorType::SAMPLED_IMAGE).image_info(&info));
                }
                Binding::Input(image) => {
                    let info = seen(image.view, input_layout(image.format));
                    update(write.descriptor_type(vk::DescriptorType::INPUT_ATTACHMENT).image_info(&info));
                }
                Binding::HostDepth(HostDepth(view)) => {
                    let info = seen(view, vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL);
                    update(write.descriptor_type(vk::DescriptorType::INPUT_ATTACHMENT).image_info(&info));
                }
            }
        }
    }
}

fn seen(image_view: vk::ImageView, image_layout: vk::ImageLayout) -> [vk::DescriptorImageInfo; 1] {
    [vk::DescriptorImageInfo { sampler: vk::Sampler::null(), image_view, image_layout }]
}

/// The layout in which an image of `format` is an input attachment.
pub fn input_layout(format: vk::Format) -> vk::ImageLayout {
    match is_depth(format) {
        true => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        false => vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    }
}

impl Drop for DescriptorSet {
    fn drop(&mut self) {
        let Self { raw, pool, kinds, device } = self;
        // SAFETY: it was given with these; the GPU is done with it (see the module's docs).
        unsafe { device.descriptor_pools.free(&device.raw, (*raw, *pool), kinds) };
    }
}
