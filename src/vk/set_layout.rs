//! Descriptor set layouts. A layout has only the bindings that are present.

use super::Device;
use super::lock;
use super::shaders::Resource;
use crate::error::{Error, Result};
use ash::vk;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, Weak};

/// A binding: number, descriptor type and shader stages.
pub(super) type SetBinding = (u32, vk::DescriptorType, vk::ShaderStageFlags);

/// The layout of a descriptor set. Equal layouts of a device are shared.
pub struct SetLayout {
    pub(super) raw: vk::DescriptorSetLayout,
    pub(super) bindings: Vec<SetBinding>,
    device: Arc<Device>,
}

/// Live descriptor set layouts of a device.
#[derive(Default)]
pub(super) struct SetLayouts(Mutex<HashMap<Vec<SetBinding>, Weak<SetLayout>>>);

impl SetLayout {
    /// The layout of these resources, all of one set.
    pub fn of<'a>(
        device: &Arc<Device>,
        resources: impl IntoIterator<Item = &'a Resource>,
    ) -> Result<Arc<Self>> {
        let binding = |resource: &Resource| (resource.binding, resource.kind, resource.stages);
        let mut bindings: Vec<_> = resources.into_iter().map(binding).collect();
        bindings.sort_by_key(|(number, ..)| *number);
        let mut known = lock(&device.set_layouts.0);
        if let Some(alive) = known.get(&bindings).and_then(Weak::upgrade) {
            return Ok(alive);
        }
        let made = Arc::new(Self::new(device, bindings)?);
        known.retain(|_, layout| layout.strong_count() > 0);
        known.insert(made.bindings.clone(), Arc::downgrade(&made));
        Ok(made)
    }

    fn new(device: &Arc<Device>, bindings: Vec<SetBinding>) -> Result<Self> {
        let describe = |(number, kind, stages): &SetBinding| {
            vk::DescriptorSetLayoutBinding::default()
                .binding(*number)
                .descriptor_type(*kind)
                .descriptor_count(1)
                .stage_flags(*stages)
        };
        let described: Vec<_> = bindings.iter().map(describe).collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&described);
        // SAFETY: `info` is valid, as no binding comes twice; the layout is destroyed in `drop`.
        let raw = unsafe { device.raw.create_descriptor_set_layout(&info, None) }
            .map_err(Error::vulkan("vkCreateDescriptorSetLayout"))?;
        Ok(Self { raw, bindings, device: device.clone() })
    }

    /// Whether it has this resource's binding with the same type.
    pub(super) fn has(&self, resource: &Resource) -> bool {
        self.bindings.iter().any(|(number, kind, _)| (*number, *kind) == (resource.binding, resource.kind))
    }

    /// Number of storage buffers that are visible to a stage.
    pub(super) fn storage_buffers(&self, stage: vk::ShaderStageFlags) -> u32 {
        let seen = |(_, kind, stages): &&SetBinding| {
            *kind == vk::DescriptorType::STORAGE_BUFFER && stages.contains(stage)
        };
        self.bindings.iter().filter(seen).count() as u32
    }
}

impl Drop for SetLayout {
    fn drop(&mut self) {
        // SAFETY: layouts may go before the pipelines made from them; sets keep theirs.
        unsafe { self.device.raw.destroy_descriptor_set_layout(self.raw, None) };
    }
}
