//! External devices: imported from a host.

use super::choose::{DeviceDescription, NO_FAMILY};
use super::descriptor_pool::DescriptorPools;
use super::device::{Device, Owner, UsageCounters};
use super::labels::Labels;
use super::limits::{Capabilities, DeviceLimits};
use super::memory::{self, MemoryBlocks, MemorySource};
use super::pipeline_cache::PipelineCache;
use super::pipeline_pool::PipelinePool;
use super::requirements::{Abilities, QUEUE};
use super::set_layout::SetLayouts;
use super::tracker::History;
use crate::error::{Error, Result};
use ash::vk;
use std::mem::ManuallyDrop;
use std::path::PathBuf;
use std::sync::Arc;

/// Description of an external device: the host keeps using it beside the engine.
pub struct ExternalDevice<'a> {
    /// The instance, of at least Vulkan 1.1.
    pub instance: &'a ash::Instance,
    /// The physical device of `device`.
    pub physical: vk::PhysicalDevice,
    /// The device.
    pub device: &'a ash::Device,
    /// Family of the queue to which the host submits: graphics and compute.
    pub queue_family: u32,
    /// The [`Abilities::of`] the device that the host has enabled.
    pub enabled: Abilities,
    /// Whether the host has enabled dynamicRendering, for [`Pass::Rendering`](crate::embed::Pass::Rendering).
    pub dynamic_rendering: bool,
    /// Whether the instance has VK_EXT_debug_utils enabled, for debug labels.
    pub labels: bool,
    /// Capabilities to hide.
    pub limits: DeviceLimits,
    /// Memory of the host; `None` uses the engine's allocator.
    pub memory: Option<Box<dyn MemorySource>>,
    /// Like [`DeviceOptions::memory_blocks`](super::DeviceOptions::memory_blocks), for the engine's allocator.
    pub memory_blocks: MemoryBlocks,
    /// Like [`DeviceOptions::pipeline_cache`](super::DeviceOptions::pipeline_cache). Written by [`Device::save_pipelines`], and when the device
    /// is dropped.
    pub pipeline_cache: Option<PathBuf>,
}

impl Device {
    /// Imports an external device: that of a host, which renders surfels among its own geometry. The engine records into the host's command
    /// buffers. It never submits, waits, or destroys the host's objects.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if the device is older than Vulkan 1.1 or allows fewer than 15 storage buffers per stage, or if the queue family
    /// lacks graphics or compute; [`Error::Usage`] if there is no such family.
    ///
    /// # Safety
    /// What `external` says of the device is true, and the device outlives what is returned and all that is made on it.
    pub unsafe fn from_external(external: ExternalDevice<'_>) -> Result<Arc<Self>> {
        let ExternalDevice { instance, physical, device, queue_family, enabled, .. } = external;
        // SAFETY: by the caller, here and below.
        let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
        let Some(family) = families.get(queue_family as usize) else {
            let count = families.len();
            return Err(Error::Usage(format!(
                "queue family {queue_family}: the device has {count}, numbered from 0"
            )));
        };
        let unserved = (!family.queue_flags.contains(QUEUE)).then_some(NO_FAMILY);
        // SAFETY: as above.
        let description = unsafe { DeviceDescription::of(instance, physical, unserved) };
        if let Some(cause) = description.refused {
            let name = &description.name;
            return Err(Error::NoDevice(format!("{name}, queue family {queue_family}: {cause}")));
        }
        // SAFETY: as above.
        let capabilities =
            unsafe { Capabilities::query(instance, physical, queue_family, enabled, &external.limits) };
        capabilities.check(&description.name)?;
        let dynamic_rendering = external.dynamic_rendering && capabilities.dynamic_rendering;
        let capabilities = Capabilities { dynamic_rendering, ..capabilities };
        let memory = match external.memory {
            Some(source) => memory::Source::Host(source),
            None => memory::Source::own(instance, device, physical, external.memory_blocks)
                .map_err(|error| Error::NoDevice(format!("{}: {error}", description.name)))?,
        };
        let pipeline_cache =
            PipelineCache::load(instance, physical, device, external.pipeline_cache.as_deref())?;
        Ok(Arc::new(Self {
            raw: device.clone(),
            memory: ManuallyDrop::new(memory),
            pipeline_cache: ManuallyDrop::new(pipeline_cache),
            pipelines: PipelinePool::default(),
            labels: external.labels.then(|| Labels::new(instance, device, false)),
            history: History::default(),
            descriptor_pools: DescriptorPools::default(),
            set_layouts: SetLayouts::default(),
            counters: UsageCounters::default(),
            capabilities,
            description,
            instance: instance.clone(),
            physical,
            owner: Owner::Host,
        }))
    }
}
