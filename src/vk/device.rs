//! The logical device: one graphics queue, the memory allocator, the pipeline cache, and counters of what was made.

use super::access::History;
use super::choose::{DeviceDescription, choose};
use super::descriptor_pool::DescriptorPools;
use super::instance::Instance;
use super::limits::{Capabilities, DeviceLimits};
use super::memory::{self, MemoryBlocks, MemorySource};
use super::pipeline_cache::PipelineCache;
use super::pipeline_pool::PipelinePool;
use super::requirements::{Abilities, QUEUE, portability_subset};
use super::set_layout::SetLayouts;
#[cfg(feature = "window")]
use super::surface::{self, Surface, Window};
use crate::error::{Error, Result};
use ash::{ext::debug_utils, vk};
use std::ffi::{CStr, CString};
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
    /// Sizes in which device memory is allocated.
    pub memory_blocks: MemoryBlocks,
}

/// An open device. Shared by everything that is made on it.
pub struct Device {
    pub(super) raw: ash::Device,
    pub(super) memory: ManuallyDrop<memory::Source>,
    pub(super) pipeline_cache: ManuallyDrop<PipelineCache>,
    /// The pipelines that are alive.
    pub(super) pipelines: PipelinePool,
    pub(super) labels: Option<debug_utils::Device>,
    pub(super) history: History,
    pub(super) descriptor_pools: DescriptorPools,
    /// The layouts of descriptor sets that are alive.
    pub(super) set_layouts: SetLayouts,
    pub(super) made: Made,
    capabilities: Capabilities,
    description: DeviceDescription,
    /// Asks `physical` what it can do.
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    owner: Owner,
}

/// Whose the device is.
enum Owner {
    /// Opened by the engine, which submits to its queue, locked while it does.
    Engine(Box<Opened>),
    /// Lent by a host, which submits what is recorded, waits for it, and destroys the device last.
    Host,
}

/// What the engine opened beside the device.
struct Opened {
    queue: Mutex<vk::Queue>,
    family: u32,
    instance: Arc<Instance>,
}

/// A device that a host lends: its own, to go on using while the engine does.
pub struct Lent<'a> {
    /// The instance, of Vulkan 1.1 at least.
    pub instance: &'a ash::Instance,
    /// The device that `device` is of.
    pub physical: vk::PhysicalDevice,
    /// The device.
    pub device: &'a ash::Device,
    /// The family of the queue to which the host submits what is recorded; it does graphics and compute.
    pub queue_family: u32,
    /// What of [`Abilities::of`] the host has enabled.
    pub enabled: Abilities,
    /// Whether the host has enabled the feature dynamicRendering, for [`Pass::Rendering`](crate::embed::Pass::Rendering).
    pub dynamic_rendering: bool,
    /// Whether the instance has VK_EXT_debug_utils enabled: passes then have labels.
    pub labels: bool,
    /// What to hide of the device.
    pub limits: DeviceLimits,
    /// Where memory comes from; `None` takes the engine's own allocator.
    pub memory: Option<Box<dyn MemorySource>>,
    /// As [`DeviceOptions::memory_blocks`], of the engine's own allocator.
    pub memory_blocks: MemoryBlocks,
    /// As [`DeviceOptions::pipeline_cache`].
    pub pipeline_cache: Option<PathBuf>,
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
#[non_exhaustive]
pub struct Usage {
    /// Buffers and images ever allocated.
    pub allocations: u64,
    /// Pipelines ever made.
    pub pipelines: u64,
    /// Device memory bound now, bytes.
    pub bytes: u64,
    /// Pools of descriptor sets that are there now.
    pub descriptor_pools: usize,
}

impl Device {
    /// Opens the device that `options` ask for.
    ///
    /// [`Error::NoDevice`] if there is none, or no Vulkan, or no validation layer where it is wanted.
    pub fn open(options: &DeviceOptions) -> Result<Arc<Self>> {
        Self::open_on(Arc::new(Instance::new(options.validate, &[])?), options, &[])
    }

    /// Opens the device that `options` ask for to present to `window`, and the window's surface.
    ///
    /// [`Error::NoDevice`] as of [`Device::open`], and if the device does not present to the window.
    #[cfg(feature = "window")]
    pub fn open_for(options: &DeviceOptions, window: Arc<dyn Window>) -> Result<(Arc<Self>, Surface)> {
        let extensions = surface::instance_extensions(&*window)?;
        let instance = Arc::new(Instance::new(options.validate, extensions)?);
        let surface = Surface::new(&instance, window)?;
        let device = Self::open_on(instance, options, &surface::DEVICE_EXTENSIONS)?;
        let (_, family) = device.queue()?;
        surface.check(device.physical, family, &device.description.name)?;
        Ok((device, surface))
    }

    fn open_on(
        instance: Arc<Instance>,
        options: &DeviceOptions,
        more: &[&'static CStr],
    ) -> Result<Arc<Self>> {
        let chosen = choose(&instance, options.select.as_deref())?;
        let (physical, family, description) = (chosen.physical, chosen.family, chosen.description);
        // SAFETY: the physical device and the family are the instance's, whose version is 1.1.
        let (enabled, capabilities) = unsafe {
            let enabled = options.limits.leave(Abilities::of(&instance.raw, physical));
            (enabled, Capabilities::query(&instance.raw, physical, family, enabled, &options.limits))
        };
        let queues =
            [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
        // SAFETY: the physical device is the instance's.
        let subset = unsafe { portability_subset(&instance.raw, physical) };
        let extensions: Vec<_> =
            enabled.extensions().chain(more.iter().copied()).chain(subset).map(CStr::as_ptr).collect();
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
        let memory = memory::Source::own(&instance.raw, &raw, physical, options.memory_blocks)
            .map_err(|error| Error::NoDevice(format!("{}: {error}", description.name)))?;
        let pipeline_cache =
            PipelineCache::load(&instance.raw, physical, &raw, options.pipeline_cache.as_deref())?;
        let labels = instance.debug_utils.then(|| debug_utils::Device::new(&instance.raw, &raw));
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
            made: Made::default(),
            capabilities,
            description,
            instance: instance.raw.clone(),
            physical,
            owner: Owner::Engine(Box::new(Opened { queue, family, instance })),
        }))
    }

    /// The device of a host that renders surfels among its own geometry. The engine records into the host's command buffers; it never
    /// submits, waits, or destroys what is lent.
    ///
    /// [`Error::NoDevice`] if the device is older than Vulkan 1.1, or the queue family does not do graphics and compute; [`Error::Usage`] if there
    /// is no such family.
    ///
    /// # Safety
    /// What `lent` says of the device is true, and the device outlives what is returned and all that is made on it.
    pub unsafe fn borrow(lent: Lent<'_>) -> Result<Arc<Self>> {
        let Lent { instance, physical, device, queue_family, enabled, .. } = lent;
        // SAFETY: by the caller, here and below.
        let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
        let Some(family) = families.get(queue_family as usize) else {
            let count = families.len();
            return Err(Error::Usage(format!(
                "queue family {queue_family}: the device has {count}, numbered from 0"
            )));
        };
        let serves = family.queue_flags.contains(QUEUE);
        // SAFETY: as above.
        let description = unsafe { DeviceDescription::of(instance, physical, serves) };
        if let Some(cause) = description.refused {
            let name = &description.name;
            return Err(Error::NoDevice(format!("{name}, queue family {queue_family}: {cause}")));
        }
        // SAFETY: as above.
        let capabilities =
            unsafe { Capabilities::query(instance, physical, queue_family, enabled, &lent.limits) };
        let dynamic_rendering = lent.dynamic_rendering && capabilities.dynamic_rendering;
        let capabilities = Capabilities { dynamic_rendering, ..capabilities };
        let memory = match lent.memory {
            Some(source) => memory::Source::Host(source),
            None => memory::Source::own(instance, device, physical, lent.memory_blocks)
                .map_err(|error| Error::NoDevice(format!("{}: {error}", description.name)))?,
        };
        let pipeline_cache = PipelineCache::load(instance, physical, device, lent.pipeline_cache.as_deref())?;
        Ok(Arc::new(Self {
            raw: device.clone(),
            memory: ManuallyDrop::new(memory),
            pipeline_cache: ManuallyDrop::new(pipeline_cache),
            pipelines: PipelinePool::default(),
            labels: lent.labels.then(|| debug_utils::Device::new(instance, device)),
            history: History::default(),
            descriptor_pools: DescriptorPools::default(),
            set_layouts: SetLayouts::default(),
            made: Made::default(),
            capabilities,
            description,
            instance: instance.clone(),
            physical,
            owner: Owner::Host,
        }))
    }

    /// Names an object of the device for debuggers and the validation layers, where they listen.
    pub(super) fn name(&self, object: impl vk::Handle, name: &str) {
        let Some((labels, name)) = self.labels.as_ref().zip(CString::new(name).ok()) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(object).object_name(&name);
        // SAFETY: the object is the device's, and alive. A name that cannot be given is no loss.
        let _ = unsafe { labels.set_debug_utils_object_name(&info) };
    }

    /// Begins a debug label, where there are any.
    ///
    /// # Safety
    /// `cmd` is of the device and is being recorded; [`Device::end_label`] ends it.
    pub(super) unsafe fn begin_label(&self, cmd: vk::CommandBuffer, label: &'static str) {
        let Some(labels) = &self.labels else { return };
        // In every pass of every frame: on the stack.
        let mut name = [0; 32];
        let length = label.len().min(name.len() - 1);
        name[..length].copy_from_slice(&label.as_bytes()[..length]);
        let Ok(name) = CStr::from_bytes_until_nul(&name) else { return };
        let info = vk::DebugUtilsLabelEXT::default().label_name(name);
        // SAFETY: by the caller.
        unsafe { labels.cmd_begin_debug_utils_label(cmd, &info) };
    }

    /// # Safety
    /// [`Device::begin_label`] began one.
    pub(super) unsafe fn end_label(&self, cmd: vk::CommandBuffer) {
        if let Some(labels) = &self.labels {
            // SAFETY: by the caller.
            unsafe { labels.cmd_end_debug_utils_label(cmd) };
        }
    }

    /// The queue that the engine submits to, and its family. A usage error on a device that a host lends: there the host submits.
    pub(super) fn queue(&self) -> Result<(&Mutex<vk::Queue>, u32)> {
        match &self.owner {
            Owner::Engine(opened) => Ok((&opened.queue, opened.family)),
            Owner::Host => Err(Error::Usage(format!(
                "the device {} is lent by a host, which alone submits: record into its command buffers, see `embed`",
                self.description.name
            ))),
        }
    }

    /// Vulkan's own, for who makes things on the device by other means; nobody destroys it.
    pub fn handle(&self) -> &ash::Device {
        &self.raw
    }

    /// The instance that asks [`Device::physical`].
    pub fn instance(&self) -> &ash::Instance {
        &self.instance
    }

    /// The physical device.
    pub fn physical(&self) -> vk::PhysicalDevice {
        self.physical
    }

    /// The queue, locked while `body` submits to it, and its family. A usage error on a device that a host lends.
    pub fn submit<R>(&self, body: impl FnOnce(vk::Queue, u32) -> R) -> Result<R> {
        let (queue, family) = self.queue()?;
        let queue = queue.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        Ok(body(*queue, family))
    }

    /// Waits until the GPU has nothing left to do: for the queue, too, while others submit to it.
    pub fn wait_idle(&self) -> Result<()> {
        let (queue, _) = self.queue()?;
        let _locked = queue.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        // SAFETY: the device's only queue is locked.
        unsafe { self.raw.device_wait_idle() }.map_err(Error::vulkan("vkDeviceWaitIdle"))
    }

    /// What images of `format` can be used for.
    pub fn format_features(&self, format: vk::Format) -> vk::FormatFeatureFlags {
        // SAFETY: the physical device is the instance's, and both outlive this.
        let found = unsafe { self.instance.get_physical_device_format_properties(self.physical, format) };
        found.optimal_tiling_features
    }

    /// How many samples a pixel an attachment of `format` can have in framebuffers; none where it cannot be one.
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
            descriptor_pools: self.descriptor_pools.count(),
        }
    }

    /// Messages of the validation layers so far; empty unless [`DeviceOptions::validate`] was set. A host listens itself.
    pub fn validation_messages(&self) -> Vec<String> {
        match &self.owner {
            Owner::Engine(opened) => opened.instance.messages.all(),
            Owner::Host => Vec::new(),
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: everything made on the device holds an `Arc` of it, so nothing is left; the allocator and the cache go before the
        // device that they use, and the instance, a field, after it.
        unsafe {
            if let Owner::Engine(_) = self.owner {
                // A lost device has nothing left to wait for.
                let _ = self.raw.device_wait_idle();
            }
            self.descriptor_pools.destroy(&self.raw);
            self.pipeline_cache.store_and_destroy(&self.raw);
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
