//! The logical device: one graphics queue, the memory allocator, the pipeline cache, and usage counters.

use super::choose::{DeviceDescription, Presentation, choose};
use super::descriptor_pool::DescriptorPools;
use super::instance::Instance;
use super::labels::Labels;
use super::limits::{Capabilities, DeviceLimits};
use super::lock;
use super::memory::{self, MemoryBlocks};
use super::pipeline_cache::PipelineCache;
use super::pipeline_pool::PipelinePool;
use super::requirements::{Abilities, portability_subset};
use super::set_layout::SetLayouts;
#[cfg(feature = "window")]
use super::surface::{self, Surface, Window};
use super::tracker::History;
use crate::error::{Error, Result};
use ash::vk;
use std::ffi::CStr;
use std::mem::ManuallyDrop;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

/// Options of [`Device::open`].
#[derive(Clone, Debug, Default)]
pub struct DeviceOptions {
    /// Index or part of the name of the device; `None` selects the device with the highest score.
    pub select: Option<String>,
    /// Enables the validation layers and collects their messages.
    ///
    /// The layers may crash where a thread opens or drops a device while another one uses a device, except the first of the process
    /// (seen with 1.3.239): there, use validated devices from one thread at a time.
    pub validate: bool,
    /// Capabilities to hide.
    pub limits: DeviceLimits,
    /// Folder of the pipeline cache on disk; `None` disables it.
    pub pipeline_cache: Option<PathBuf>,
    /// Sizes of memory objects.
    pub memory_blocks: MemoryBlocks,
}

/// An open device. Everything that is created on it shares it.
pub struct Device {
    pub(super) raw: ash::Device,
    pub(super) memory: ManuallyDrop<memory::Source>,
    pub(super) pipeline_cache: ManuallyDrop<PipelineCache>,
    /// Live pipelines.
    pub(super) pipelines: PipelinePool,
    pub(super) labels: Option<Labels>,
    pub(super) history: History,
    pub(super) descriptor_pools: DescriptorPools,
    /// Live descriptor set layouts.
    pub(super) set_layouts: SetLayouts,
    pub(super) counters: UsageCounters,
    pub(super) capabilities: Capabilities,
    pub(super) description: DeviceDescription,
    /// For queries of `physical`.
    pub(super) instance: ash::Instance,
    pub(super) physical: vk::PhysicalDevice,
    pub(super) owner: Owner,
}

/// Owner of the device.
pub(super) enum Owner {
    /// The engine opened the device, and locks its queue to submit.
    Engine(Box<Opened>),
    /// An external device: the host submits, waits, and destroys the device last.
    Host,
}

/// Further objects of a device that the engine opened.
pub(super) struct Opened {
    queue: Mutex<vk::Queue>,
    family: u32,
    instance: Arc<Instance>,
}

/// Counters for [`Device::usage`].
#[derive(Default)]
pub(super) struct UsageCounters {
    pub(super) allocations: AtomicU64,
    pub(super) pipelines: AtomicU64,
    pub(super) bytes: AtomicU64,
}

/// What a device holds and has made, to prove that a frame makes nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Usage {
    /// Number of buffers and images ever allocated.
    pub allocations: u64,
    /// Number of pipelines ever created.
    pub pipelines: u64,
    /// Device memory in use, bytes.
    pub bytes: u64,
    /// Current number of descriptor pools.
    pub descriptor_pools: usize,
}

impl Device {
    /// Opens the device that `options` select.
    ///
    /// # Errors
    /// [`Error::NoDevice`] if there is no such device, no Vulkan, or no validation layer although `validate` is set. Devices that are older
    /// than Vulkan 1.1, allow fewer than 15 storage buffers per stage, or lack a queue family with graphics and compute are not selected: see
    /// [`DeviceDescription::refused`].
    pub fn open(options: &DeviceOptions) -> Result<Arc<Self>> {
        Self::open_on(Arc::new(Instance::new(options.validate, &[])?), options, None)
    }

    /// Opens the device that `options` select, of those that present to `window`, and creates the window's surface.
    ///
    /// # Errors
    /// [`Error::NoDevice`] as [`Device::open`], and if no selected device presents to the window.
    #[cfg(feature = "window")]
    pub fn open_for(options: &DeviceOptions, window: Arc<dyn Window>) -> Result<(Arc<Self>, Surface)> {
        let extensions = surface::instance_extensions(&*window)?;
        let instance = Arc::new(Instance::new(options.validate, extensions)?);
        let surface = Surface::new(&instance, window)?;
        let presents = |physical, family| surface.is_served_by(physical, family);
        let window = Presentation { extensions: &surface::DEVICE_EXTENSIONS, presents: &presents };
        let device = Self::open_on(instance, options, Some(&window))?;
        Ok((device, surface))
    }

    fn open_on(
        instance: Arc<Instance>,
        options: &DeviceOptions,
        window: Option<&Presentation<'_>>,
    ) -> Result<Arc<Self>> {
        let chosen = choose(&instance, options.select.as_deref(), window)?;
        let (physical, family, description) = (chosen.physical, chosen.family, chosen.description);
        // SAFETY: the physical device and the family are of the instance, whose version is 1.1.
        let (enabled, capabilities) = unsafe {
            let enabled = options.limits.leave(Abilities::of(&instance.raw, physical));
            (enabled, Capabilities::query(&instance.raw, physical, family, enabled, &options.limits))
        };
        let queues =
            [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
        // SAFETY: the physical device is the instance's.
        let subset = unsafe { portability_subset(&instance.raw, physical) };
        let of_window = window.iter().flat_map(|window| window.extensions).copied();
        let extensions: Vec<_> =
            enabled.extensions().chain(of_window).chain(subset).map(CStr::as_ptr).collect();
        let mut features = enabled.features();
        let core = features.core;
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_features(&core)
            .enabled_extension_names(&extensions);
        // SAFETY: the physical device is the instance's, the family one of its own, and it has the extensions asked for.
        let raw = unsafe { instance.raw.create_device(physical, &features.chain(info), None) }
            .map_err(|result| Error::NoDevice(format!("{}: vkCreateDevice: {result}", description.name)))?;
        // SAFETY: the queue was asked for above.
        let queue = Mutex::new(unsafe { raw.get_device_queue(family, 0) });
        let made = memory::Source::own(&instance.raw, &raw, physical, options.memory_blocks)
            .map_err(|error| Error::NoDevice(format!("{}: {error}", description.name)))
            .and_then(|memory| {
                let file = options.pipeline_cache.as_deref();
                PipelineCache::load(&instance.raw, physical, &raw, file).map(|cache| (memory, cache))
            });
        // SAFETY: nothing is left of what was created on the device.
        let (memory, pipeline_cache) = made.inspect_err(|_| unsafe { raw.destroy_device(None) })?;
        let labels = instance.debug_utils.then(|| Labels::new(&instance.raw, &raw, options.validate));
        log::info!("device: {} ({}, {})", description.name, description.kind, description.driver);
        Ok(Arc::new(Self {
            raw,
            memory: ManuallyDrop::new(memory),
            pipeline_cache: ManuallyDrop::new(pipeline_cache),
            pipelines: PipelinePool::default(),
            labels,
            history: History::default(),
            descriptor_pools: DescriptorPools::default(),
            set_layouts: SetLayouts::default(),
            counters: UsageCounters::default(),
            capabilities,
            description,
            instance: instance.raw.clone(),
            physical,
            owner: Owner::Engine(Box::new(Opened { queue, family, instance })),
        }))
    }

    /// Names an object of the device for debuggers and the validation layers.
    pub(super) fn name(&self, object: impl vk::Handle, name: &str) {
        if let Some(labels) = &self.labels {
            // SAFETY: the object is of the device and alive.
            unsafe { labels.name(object, name) };
        }
    }

    /// Begins a debug label, if labels are enabled.
    ///
    /// # Safety
    /// `cmd` is of the device and recording; [`Device::end_label`] ends the label.
    pub(super) unsafe fn begin_label(&self, cmd: vk::CommandBuffer, label: &'static str) {
        if let Some(labels) = &self.labels {
            // SAFETY: by the caller.
            unsafe { labels.begin(cmd, label) };
        }
    }

    /// # Safety
    /// [`Device::begin_label`] began one.
    pub(super) unsafe fn end_label(&self, cmd: vk::CommandBuffer) {
        if let Some(labels) = &self.labels {
            // SAFETY: by the caller.
            unsafe { labels.end(cmd) };
        }
    }

    /// The queue that the engine submits to, and its family; [`Error::Usage`] on an external device, where the host submits.
    pub(super) fn queue(&self) -> Result<(&Mutex<vk::Queue>, u32)> {
        match &self.owner {
            Owner::Engine(opened) => Ok((&opened.queue, opened.family)),
            Owner::Host => Err(Error::Usage(format!(
                "the device {} belongs to a host, which submits: record into its command buffers, see `embed`",
                self.description.name
            ))),
        }
    }

    /// The Vulkan handle. The caller must not destroy it.
    pub fn handle(&self) -> &ash::Device {
        &self.raw
    }

    /// The instance of [`Device::physical`].
    pub fn instance(&self) -> &ash::Instance {
        &self.instance
    }

    /// The physical device.
    pub fn physical(&self) -> vk::PhysicalDevice {
        self.physical
    }

    /// Calls `body` with the locked queue and its family; [`Error::Usage`] on an external device.
    pub fn submit<R>(&self, body: impl FnOnce(vk::Queue, u32) -> R) -> Result<R> {
        let (queue, family) = self.queue()?;
        let queue = lock(queue);
        Ok(body(*queue, family))
    }

    /// Waits until the device is idle. Locks the queue meanwhile.
    pub fn wait_idle(&self) -> Result<()> {
        let (queue, _) = self.queue()?;
        let _locked = lock(queue);
        let _alone = self.lock_if_validated();
        // SAFETY: the device's only queue is locked.
        unsafe { self.raw.device_wait_idle() }.map_err(Error::vulkan("vkDeviceWaitIdle"))
    }

    /// Keeps other threads from recording during a submission or a wait under validation: see [`Labels`].
    pub(super) fn lock_if_validated(&self) -> Option<MutexGuard<'_, ()>> {
        self.labels.as_ref().and_then(Labels::lock_if_validated)
    }

    /// Waits for a fence.
    ///
    /// # Safety
    /// The fence is of the device, and submitted or signalled.
    pub(super) unsafe fn wait(&self, fence: vk::Fence) -> Result<()> {
        // SAFETY: by the caller.
        let waited = unsafe {
            match &self.labels {
                Some(labels) => labels.wait(&self.raw, fence),
                None => self.raw.wait_for_fences(&[fence], true, u64::MAX),
            }
        };
        waited.map_err(Error::vulkan("vkWaitForFences"))
    }

    /// Features of `format` with optimal tiling.
    pub fn format_features(&self, format: vk::Format) -> vk::FormatFeatureFlags {
        // SAFETY: the physical device is the instance's, and both outlive this.
        let found = unsafe { self.instance.get_physical_device_format_properties(self.physical, format) };
        found.optimal_tiling_features
    }

    /// Supported sample counts of attachments of `format`; empty if it cannot be an attachment.
    pub(crate) fn attachment_samples(
        &self,
        format: vk::Format,
        usage: vk::ImageUsageFlags,
    ) -> vk::SampleCountFlags {
        let (kind, tiling) = (vk::ImageType::TYPE_2D, vk::ImageTiling::OPTIMAL);
        // SAFETY: the physical device is the instance's, and both outlive this.
        let (limits, found) = unsafe {
            let limits = self.instance.get_physical_device_properties(self.physical).limits;
            let flags = vk::ImageCreateFlags::empty();
            let found = self.instance.get_physical_device_image_format_properties(
                self.physical,
                format,
                kind,
                tiling,
                usage,
                flags,
            );
            (limits, found)
        };
        let framebuffer = if usage.contains(vk::ImageUsageFlags::COLOR_ATTACHMENT) {
            limits.framebuffer_color_sample_counts
        } else {
            limits.framebuffer_depth_sample_counts | limits.framebuffer_stencil_sample_counts
        };
        found.map_or(vk::SampleCountFlags::empty(), |found| found.sample_counts & framebuffer)
    }

    /// Name, kind and driver of the device.
    pub fn description(&self) -> &DeviceDescription {
        &self.description
    }

    /// Capabilities after the mask.
    pub fn capabilities(&self) -> &Capabilities {
        &self.capabilities
    }

    /// Usage counters.
    pub fn usage(&self) -> Usage {
        let read = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        Usage {
            allocations: read(&self.counters.allocations),
            pipelines: read(&self.counters.pipelines),
            bytes: read(&self.counters.bytes),
            descriptor_pools: self.descriptor_pools.count(),
        }
    }

    /// Messages of the validation layers so far; empty without [`DeviceOptions::validate`] and on external devices.
    pub fn validation_messages(&self) -> Vec<String> {
        match &self.owner {
            Owner::Engine(opened) => opened.instance.messages.all(),
            Owner::Host => Vec::new(),
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: everything created on the device holds an `Arc` of it, so nothing is left. The allocator and the cache are dropped before
        // the device, and the instance, a field, after it.
        unsafe {
            if let Owner::Engine(_) = self.owner {
                // A lost device has nothing left to wait for.
                let _ = self.raw.device_wait_idle();
            }
            self.pipelines.destroy(&self.raw);
            self.descriptor_pools.destroy(&self.raw);
            self.pipeline_cache.save_and_destroy(&self.raw);
            ManuallyDrop::drop(&mut self.pipeline_cache);
            ManuallyDrop::drop(&mut self.memory);
            if let Owner::Engine(_) = self.owner {
                self.raw.destroy_device(None);
            }
        }
    }
}

impl std::fmt::Debug for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Device").field("description", &self.description).finish_non_exhaustive()
    }
}
