//! The logical device: one graphics queue, the memory allocator, the pipeline cache, and counters of what was made.

use super::choose::{DeviceDescription, choose};
use super::instance::Instance;
use super::limits::{Capabilities, DeviceLimits};
use super::pipeline_cache::PipelineCache;
use crate::error::{Error, Result};
use ash::{ext::debug_utils, vk};
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use std::mem::ManuallyDrop;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

/// How a device is opened.
#[derive(Clone, Debug, Default)]
pub struct DeviceOptions {
    /// An index or a part of a name; `None` takes the one with the highest score.
    pub select: Option<String>,
    /// Run under the validation layers and collect their messages.
    pub validate: bool,
    /// What to hide of the device.
    pub limits: DeviceLimits,
    /// Folder in which compiled pipelines are kept between runs; `None` keeps none.
    pub pipeline_cache: Option<PathBuf>,
}

/// An open device. Shared by everything that is made on it.
pub struct Device {
    pub(super) raw: ash::Device,
    /// Locked while work is submitted.
    pub(super) queue: Mutex<vk::Queue>,
    pub(super) family: u32,
    pub(super) allocator: ManuallyDrop<Mutex<Allocator>>,
    pub(super) pipeline_cache: ManuallyDrop<PipelineCache>,
    pub(super) labels: Option<debug_utils::Device>,
    pub(super) made: Made,
    capabilities: Capabilities,
    description: DeviceDescription,
    instance: Instance,
}

/// Counts of what was ever made; [`Device::usage`] reads them.
#[derive(Default)]
pub(super) struct Made {
    pub(super) allocations: AtomicU64,
    pub(super) pipelines: AtomicU64,
    pub(super) bytes: AtomicU64,
}

/// What a device holds and has made, to prove that a frame makes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Usage {
    /// Buffers and images ever allocated.
    pub allocations: u64,
    /// Pipelines ever made.
    pub pipelines: u64,
    /// Device memory bound now, bytes.
    pub bytes: u64,
}

impl Device {
    /// Opens the device that `options` ask for.
    ///
    /// [`Error::NoDevice`] if there is none, or no Vulkan, or no validation layer where it is wanted.
    pub fn open(options: &DeviceOptions) -> Result<Arc<Self>> {
        let instance = Instance::new(options.validate)?;
        let chosen = choose(&instance, options.select.as_deref())?;
        let (physical, family, description) = (chosen.physical, chosen.family, chosen.description);
        let capabilities = Capabilities::query(&instance, physical, family, &options.limits);
        let queues =
            [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
        let mut floats =
            vk::PhysicalDeviceShaderAtomicFloatFeaturesEXT::default().shader_buffer_float32_atomic_add(true);
        let mut integers =
            vk::PhysicalDeviceShaderAtomicInt64Features::default().shader_buffer_int64_atomics(true);
        let features = vk::PhysicalDeviceFeatures::default()
            .shader_int64(capabilities.int64_atomics)
            .fragment_stores_and_atomics(capabilities.fragment_writes);
        let mut extensions = Vec::new();
        let mut info =
            vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_features(&features);
        if capabilities.float_atomics {
            extensions.push(ash::ext::shader_atomic_float::NAME.as_ptr());
            info = info.push_next(&mut floats);
        }
        if capabilities.int64_atomics {
            extensions.push(ash::khr::shader_atomic_int64::NAME.as_ptr());
            info = info.push_next(&mut integers);
        }
        info = info.enabled_extension_names(&extensions);
        // SAFETY: the physical device is the instance's, the family one of its own, and it has the extensions asked for.
        let raw = unsafe { instance.raw.create_device(physical, &info, None) }
            .map_err(|result| Error::NoDevice(format!("{}: vkCreateDevice: {result}", description.name)))?;
        // SAFETY: the queue was asked for above.
        let queue = unsafe { raw.get_device_queue(family, 0) };
        let allocator = Allocator::new(&AllocatorCreateDesc {
            instance: instance.raw.clone(),
            device: raw.clone(),
            physical_device: physical,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: gpu_allocator::AllocationSizes::default(),
        })
        .map_err(|error| Error::NoDevice(format!("{}: {error}", description.name)))?;
        let pipeline_cache =
            PipelineCache::load(&instance, physical, &raw, options.pipeline_cache.as_deref())?;
        let labels = instance.debug_utils.then(|| debug_utils::Device::new(&instance.raw, &raw));
        log::info!("device: {} ({}, {})", description.name, description.kind, description.driver);
        Ok(Arc::new(Self {
            raw,
            queue: Mutex::new(queue),
            family,
            allocator: ManuallyDrop::new(Mutex::new(allocator)),
            pipeline_cache: ManuallyDrop::new(pipeline_cache),
            labels,
            made: Made::default(),
            capabilities,
            description,
            instance,
        }))
    }

    /// Name, kind and driver.
    pub fn description(&self) -> &DeviceDescription {
        &self.description
    }

    /// What it can do, after the mask.
    pub fn capabilities(&self) -> &Capabilities {
        &self.capabilities
    }

    /// What it holds and has made.
    pub fn usage(&self) -> Usage {
        let read = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        Usage {
            allocations: read(&self.made.allocations),
            pipelines: read(&self.made.pipelines),
            bytes: read(&self.made.bytes),
        }
    }

    /// Messages of the validation layers so far; empty unless [`DeviceOptions::validate`] was set.
    pub fn validation_messages(&self) -> Vec<String> {
        self.instance.messages.all()
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: everything made on the device holds an `Arc` of it, so nothing is left; the allocator and the cache go before the
        // device that they use, and the instance, a field, after it.
        unsafe {
            // A lost device has nothing left to wait for.
            let _ = self.raw.device_wait_idle();
            self.pipeline_cache.store_and_destroy(&self.raw);
            ManuallyDrop::drop(&mut self.pipeline_cache);
            ManuallyDrop::drop(&mut self.allocator);
            self.raw.destroy_device(None);
        }
    }
}

impl std::fmt::Debug for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Device").field("description", &self.description).finish_non_exhaustive()
    }
}
