//! Descriptor sets: what shaders see of buffers and images.

use super::set_layout::SetLayout;
use super::shaders::Resource;
use super::{Buffer, Device, Image, image::is_depth};
use crate::error::Result;
use ash::vk;
use std::sync::Arc;

/// What stands at one binding.
#[derive(Clone, Copy)]
pub enum Binding<'a> {
    /// A range of a uniform buffer: offset and length, bytes.
    Uniform(&'a Buffer, u64, u64),
    /// A range of a storage buffer: offset and length, bytes.
    Storage(&'a Buffer, u64, u64),
    /// An image that the shader fetches from.
    Sampled(&'a Image),
    /// An attachment that an earlier subpass wrote, at the pixel that is drawn.
    Input(&'a Image),
    /// The same of a host's depth.
    HostDepth(HostDepth),
}

impl<'a> Binding<'a> {
    /// All of a storage buffer.
    pub fn whole(buffer: &'a Buffer) -> Self {
        Self::Storage(buffer, 0, buffer.size())
    }
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

/// A descriptor set, written once.
pub struct DescriptorSet {
    pub(super) raw: vk::DescriptorSet,
    pool: vk::DescriptorPool,
    layout: Arc<SetLayout>,
    device: Arc<Device>,
}

impl DescriptorSet {
    /// A set of these, which are all of one set. What they name must outlive the set's last use.
    pub fn new(device: &Arc<Device>, bindings: &[(&Resource, Binding<'_>)]) -> Result<Self> {
        let layout = SetLayout::of(device, bindings.iter().map(|(resource, _)| *resource))?;
        let kinds: Vec<_> = layout.bindings.iter().map(|(_, kind, _)| *kind).collect();
        let (raw, pool) = device.descriptor_pools.allocate(&device.raw, layout.raw, &kinds)?;
        let set = Self { raw, pool, layout, device: device.clone() };
        set.write(bindings);
        Ok(set)
    }

    /// Its layout.
    pub fn layout(&self) -> &Arc<SetLayout> {
        &self.layout
    }

    fn write(&self, bindings: &[(&Resource, Binding<'_>)]) {
        for (resource, binding) in bindings {
            assert_eq!(resource.kind, binding.kind(), "{} is of another kind", resource.name);
            let write = vk::WriteDescriptorSet::default()
                .dst_set(self.raw)
                .dst_binding(resource.binding)
                .descriptor_type(resource.kind);
            let update = |write: vk::WriteDescriptorSet<'_>| {
                // SAFETY: the set is new, so no command uses it, and the layout has this binding with this kind.
                unsafe { self.device.raw.update_descriptor_sets(&[write], &[]) }
            };
            match *binding {
                Binding::Uniform(buffer, offset, size) | Binding::Storage(buffer, offset, size) => {
                    update(write.buffer_info(&range(buffer, offset, size)));
                }
                Binding::Sampled(image) => {
                    update(write.image_info(&seen(image.view, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)));
                }
                Binding::Input(image) => {
                    update(write.image_info(&seen(image.view, input_layout(image.format))));
                }
                Binding::HostDepth(HostDepth(view)) => {
                    let layout = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;
                    update(write.image_info(&seen(view, layout)));
                }
            }
        }
    }
}

impl Binding<'_> {
    fn kind(&self) -> vk::DescriptorType {
        match self {
            Self::Uniform(..) => vk::DescriptorType::UNIFORM_BUFFER,
            Self::Storage(..) => vk::DescriptorType::STORAGE_BUFFER,
            Self::Sampled(_) => vk::DescriptorType::SAMPLED_IMAGE,
            Self::Input(_) | Self::HostDepth(_) => vk::DescriptorType::INPUT_ATTACHMENT,
        }
    }
}

fn range(buffer: &Buffer, offset: u64, range: u64) -> [vk::DescriptorBufferInfo; 1] {
    [vk::DescriptorBufferInfo { buffer: buffer.raw, offset, range }]
}

fn seen(image_view: vk::ImageView, image_layout: vk::ImageLayout) -> [vk::DescriptorImageInfo; 1] {
    [vk::DescriptorImageInfo { sampler: vk::Sampler::null(), image_view, image_layout }]
}

/// The layout in which an image of `format` is an input attachment.
pub fn input_layout(format: vk::Format) -> vk::ImageLayout {
    if is_depth(format) {
        vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL
    } else {
        vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL
    }
}

impl Drop for DescriptorSet {
    fn drop(&mut self) {
        let kinds: Vec<_> = self.layout.bindings.iter().map(|(_, kind, _)| *kind).collect();
        // SAFETY: it was given with these; the GPU is done with it (see the module's docs).
        unsafe { self.device.descriptor_pools.free(&self.device.raw, (self.raw, self.pool), &kinds) };
    }
}
