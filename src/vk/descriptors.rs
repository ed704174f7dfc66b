//! Descriptor sets.

use super::set_layout::SetLayout;
use super::shaders::Resource;
use super::{Buffer, Device, Image, TexelView, image::is_depth};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// The resource at a binding.
#[derive(Clone, Copy)]
pub enum Binding<'a> {
    /// Range of a uniform buffer: offset and size, bytes.
    Uniform(&'a Buffer, u64, u64),
    /// Range of a storage buffer: offset and size, bytes.
    Storage(&'a Buffer, u64, u64),
    /// Uniform texel buffer.
    Texels(&'a TexelView),
    /// Sampled image.
    Sampled(&'a Image),
    /// Sampled image in `GENERAL` layout: [`super::ImageUse::Stored`].
    Fetched(&'a Image),
    /// Storage image.
    Stored(&'a Image),
    /// Input attachment.
    Input(&'a Image),
    /// The host's depth as input attachment.
    HostDepth(HostDepth),
    /// The host's depth as sampled image, in this layout.
    SampledHostDepth(HostDepth, vk::ImageLayout),
}

impl<'a> Binding<'a> {
    /// A whole storage buffer.
    pub fn whole(buffer: &'a Buffer) -> Self {
        Self::Storage(buffer, 0, buffer.size())
    }
}

/// A host's depth attachment.
#[derive(Clone, Copy, Debug)]
pub struct HostDepth(vk::ImageView);

impl HostDepth {
    /// # Safety
    /// `view` is of the depth aspect only of the host's attachment, and outlives the descriptor sets that it is written to.
    pub unsafe fn new(view: vk::ImageView) -> Self {
        Self(view)
    }
}

/// An immutable descriptor set.
pub struct DescriptorSet {
    pub(super) raw: vk::DescriptorSet,
    pool: vk::DescriptorPool,
    layout: Arc<SetLayout>,
    device: Arc<Device>,
}

impl DescriptorSet {
    /// Creates a set of these bindings, all of one set. The bound resources must outlive the set's last use. Fails if a range of a storage buffer
    /// is larger than the device allows.
    pub fn new(device: &Arc<Device>, bindings: &[(&Resource, Binding<'_>)]) -> Result<Self> {
        let most = device.capabilities().max_storage_buffer_range;
        for (resource, binding) in bindings {
            if let Binding::Storage(.., size) = *binding
                && size > most
            {
                return Err(Error::Usage(format!(
                    "{} has {size} bytes, and a storage buffer at most {most}: render fewer surfels or pixels at once",
                    resource.name
                )));
            }
        }
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
                    update(write.buffer_info(&buffer_info(buffer, offset, size)));
                }
                Binding::Texels(view) => update(write.texel_buffer_view(&[view.raw])),
                Binding::Sampled(image) => {
                    update(
                        write.image_info(&image_info(image.view, vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL)),
                    );
                }
                Binding::Stored(image) | Binding::Fetched(image) => {
                    update(write.image_info(&image_info(image.view, vk::ImageLayout::GENERAL)));
                }
                Binding::Input(image) => {
                    update(write.image_info(&image_info(image.view, input_layout(image.format))));
                }
                Binding::HostDepth(HostDepth(view)) => {
                    let layout = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;
                    update(write.image_info(&image_info(view, layout)));
                }
                Binding::SampledHostDepth(HostDepth(view), layout) => {
                    update(write.image_info(&image_info(view, layout)));
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
            Self::Texels(_) => vk::DescriptorType::UNIFORM_TEXEL_BUFFER,
            Self::Sampled(_) | Self::Fetched(_) | Self::SampledHostDepth(..) => {
                vk::DescriptorType::SAMPLED_IMAGE
            }
            Self::Stored(_) => vk::DescriptorType::STORAGE_IMAGE,
            Self::Input(_) | Self::HostDepth(_) => vk::DescriptorType::INPUT_ATTACHMENT,
        }
    }
}

fn buffer_info(buffer: &Buffer, offset: u64, range: u64) -> [vk::DescriptorBufferInfo; 1] {
    [vk::DescriptorBufferInfo { buffer: buffer.raw, offset, range }]
}

fn image_info(image_view: vk::ImageView, image_layout: vk::ImageLayout) -> [vk::DescriptorImageInfo; 1] {
    [vk::DescriptorImageInfo { sampler: vk::Sampler::null(), image_view, image_layout }]
}

/// Layout of an input attachment of `format`.
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
