//! Images of the passes.

use crate::error::Result;
use crate::frame::resource::Resource;
use crate::vk::shaders::resource;
use crate::vk::{Access, Binding, DescriptorSet, Device, Image, ImageUse, SetLayout, Use};
use ash::vk::{Format, ShaderStageFlags};
use std::sync::Arc;

/// Images of one size, with their descriptor sets.
pub(super) struct Targets {
    // Drop order: sets before their images.
    /// Descriptor set 1 of the compute passes.
    pub(super) set: DescriptorSet,
    /// Descriptor set 0 of the draw.
    pub(super) picture: DescriptorSet,
    pub(super) size: [u32; 2],
    image: Image,
    distances: Image,
    occlusion: Option<Image>,
}

impl Targets {
    /// Creates images for `size` px, with one of ambient occlusion if the passes have it.
    pub(super) fn new(device: &Arc<Device>, size: [u32; 2], ao: bool) -> Result<Self> {
        let image = |name, format, size| Image::target(device, name, format, size, ImageUse::StoredOutput);
        let colours = Format::R32G32B32A32_SFLOAT;
        let blocks = size.map(|side| side.div_ceil(2));
        let occlusion = ao.then(|| image("occlusion", colours, blocks)).transpose()?;
        let distances = image("distances", Format::R32_SFLOAT, size)?;
        let image = image("factors", colours, size)?;
        let stored = [(&resource::IMAGE_OUTPUT, &image), (&resource::DEPTH_OUTPUT, &distances)];
        let stored = stored.into_iter().chain(occlusion.iter().map(|image| (&resource::OCCLUSION, image)));
        let stored: Vec<_> = stored.map(|(resource, image)| (resource, Binding::Stored(image))).collect();
        Ok(Self {
            set: DescriptorSet::new(device, &stored)?,
            picture: DescriptorSet::new(device, &[(&resource::PICTURE_IMAGE, Binding::Sampled(&image))])?,
            size,
            image,
            distances,
            occlusion,
        })
    }

    /// Layout of descriptor set 1.
    pub(super) fn layout(device: &Arc<Device>, ao: bool) -> Result<Arc<SetLayout>> {
        let occlusion = ao.then_some(&resource::OCCLUSION);
        SetLayout::of(device, [&resource::IMAGE_OUTPUT, &resource::DEPTH_OUTPUT].into_iter().chain(occlusion))
    }

    /// Whether the images are for this size and these passes.
    pub(super) fn fits(&self, size: [u32; 2], ao: bool) -> bool {
        self.size == size && self.occlusion.is_some() == ao
    }

    /// Accesses of a compute pass that reads and writes these resources.
    pub(super) fn uses(&self, reads: &[Resource], writes: &[Resource]) -> Vec<Use> {
        let all = [(reads, false), (writes, true)];
        let all = all.iter().flat_map(|(list, write)| list.iter().map(move |resource| (*resource, *write)));
        let used = |(resource, write)| {
            let access = Access::of_shader(ShaderStageFlags::COMPUTE, write).of_stored_image();
            Some(self.image(resource)?.with(access))
        };
        all.filter_map(used).collect()
    }

    /// The access of the draw.
    pub(super) fn drawn(&self) -> Use {
        self.image.with(Access::FRAGMENT_READ)
    }

    fn image(&self, resource: Resource) -> Option<&Image> {
        match resource {
            Resource::Image => Some(&self.image),
            Resource::Depth => Some(&self.distances),
            Resource::Occlusion => self.occlusion.as_ref(),
            _ => None,
        }
    }
}
