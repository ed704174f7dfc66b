//! A small renderer, as an example of a host: it owns instance, device, queue and command buffers.

#![allow(dead_code, reason = "no host uses all of it")]

#[macro_use]
mod shader;

pub mod arguments;
pub mod composite;
pub mod darkening;
pub mod demo;
#[cfg(feature = "viewer")]
pub mod event_loop;
pub mod fog;
pub mod frame;
pub mod image;
pub mod memory;
pub mod mesh;
pub mod models;
pub mod native;
#[cfg(feature = "viewer")]
pub mod presenter;
pub mod scene;
pub mod simulation;
#[cfg(feature = "viewer")]
pub mod soak;
pub mod sphere;
#[cfg(feature = "viewer")]
pub mod surface;
#[cfg(feature = "viewer")]
pub mod swapchain;
pub mod under_way;
#[cfg(feature = "viewer")]
pub mod window;

use ash::{ext, khr, vk};
use std::error::Error;
use std::ffi::{CStr, c_char, c_void};
use std::sync::{Arc, Mutex};
use surfel::embed::{Abilities, ExternalDevice, MemorySource};
use surfel::vk::{Device, DeviceLimits};

/// A result with any error.
pub type Result<T> = std::result::Result<T, Box<dyn Error>>;

/// Vulkan objects of the host.
pub struct Host {
    pub device: ash::Device,
    pub instance: ash::Instance,
    pub physical: vk::PhysicalDevice,
    pub queue: vk::Queue,
    pub family: u32,
    /// The engine's optional features that it has enabled.
    pub enabled: Abilities,
    pub rendering: khr::dynamic_rendering::Device,
    pool: vk::CommandPool,
    messenger: vk::DebugUtilsMessengerEXT,
    debug: ext::debug_utils::Instance,
    messages: Arc<Mutex<Vec<String>>>,
    _entry: ash::Entry,
}

/// Use of the validation layers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Validation {
    Needed,
    WhereThere,
    Off,
}

/// Submitted commands.
pub struct Submitted {
    cmd: vk::CommandBuffer,
    fence: vk::Fence,
}

const VALIDATION: &CStr = c"VK_LAYER_KHRONOS_validation";

impl Host {
    /// Opens the first device with graphics and compute; with the validation layers if installed, which they must be if `validates`.
    pub fn open(wanted: fn(Abilities) -> Abilities, validates: bool) -> Result<Self> {
        let validation = if validates { Validation::Needed } else { Validation::WhereThere };
        Self::open_with(wanted, validation, &[], &[])
    }

    /// Like [`Host::open`], with these raw instance extensions and device extensions.
    pub fn open_with(
        wanted: fn(Abilities) -> Abilities,
        validation: Validation,
        of_instance: &[*const c_char],
        of_device: &[&'static CStr],
    ) -> Result<Self> {
        // SAFETY: plain Vulkan: every handle is created here, and destroyed in `drop` after the objects that depend on it.
        unsafe {
            let entry = ash::Entry::load()?;
            let layers = entry.enumerate_instance_layer_properties()?;
            let there = layers.iter().any(|layer| layer.layer_name_as_c_str() == Ok(VALIDATION));
            if validation == Validation::Needed && !there {
                return Err(
                    "VK_LAYER_KHRONOS_validation is not installed (Debian: vulkan-validationlayers)".into()
                );
            }
            let there = there && validation != Validation::Off;
            let layers: Vec<_> = there.then_some(VALIDATION.as_ptr()).into_iter().collect();
            let mut extensions = vec![ext::debug_utils::NAME.as_ptr()];
            extensions.extend(of_instance);
            let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_2);
            let synchronization = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
            let mut features =
                vk::ValidationFeaturesEXT::default().enabled_validation_features(&synchronization);
            let mut info = vk::InstanceCreateInfo::default()
                .application_info(&application)
                .enabled_layer_names(&layers)
                .enabled_extension_names(&extensions);
            if there {
                info = info.push_next(&mut features);
            }
            let messages = Arc::new(Mutex::new(Vec::new()));
            // Reports messages about the instance, too.
            let mut whole = messenger(&messages);
            let instance = entry.create_instance(&info.push_next(&mut whole), None)?;
            let debug = ext::debug_utils::Instance::new(&entry, &instance);
            let messenger = debug.create_debug_utils_messenger(&messenger(&messages), None)?;
            let (physical, family) = choose(&instance)?;
            let enabled = wanted(Abilities::of(&instance, physical));
            let device = create_device(&instance, physical, family, &enabled, of_device)?;
            let pool = vk::CommandPoolCreateInfo::default()
                .queue_family_index(family)
                .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
            Ok(Self {
                pool: device.create_command_pool(&pool, None)?,
                queue: device.get_device_queue(family, 0),
                rendering: khr::dynamic_rendering::Device::new(&instance, &device),
                device,
                instance,
                physical,
                family,
                enabled,
                messenger,
                debug,
                messages,
                _entry: entry,
            })
        }
    }

    /// Imports the device into the engine.
    pub fn external_device(&self, memory: Option<Box<dyn MemorySource>>) -> surfel::Result<Arc<Device>> {
        self.external_device_within(DeviceLimits::default(), memory)
    }

    /// The same, without the capabilities that `limits` hide.
    pub fn external_device_within(
        &self,
        limits: DeviceLimits,
        memory: Option<Box<dyn MemorySource>>,
    ) -> surfel::Result<Arc<Device>> {
        self.external_device_as(&self.device, limits, memory)
    }

    /// The same, with functions of the device replaced by `replace`, by name; each replacement calls the original.
    pub fn external_device_replaced(
        &self,
        replace: impl Fn(&CStr) -> Option<*const c_void>,
    ) -> surfel::Result<Arc<Device>> {
        let find = |name: &CStr| {
            // SAFETY: the device is alive.
            let found = unsafe { self.instance.get_device_proc_addr(self.device.handle(), name.as_ptr()) };
            found.map_or(std::ptr::null(), |found| found as *const c_void)
        };
        // SAFETY: the functions are the device's, or call them.
        let device = unsafe {
            ash::Device::load_with(|name| replace(name).unwrap_or_else(|| find(name)), self.device.handle())
        };
        self.external_device_as(&device, DeviceLimits::default(), None)
    }

    fn external_device_as(
        &self,
        device: &ash::Device,
        limits: DeviceLimits,
        memory: Option<Box<dyn MemorySource>>,
    ) -> surfel::Result<Arc<Device>> {
        let external = ExternalDevice {
            instance: &self.instance,
            physical: self.physical,
            device,
            queue_family: self.family,
            enabled: self.enabled,
            dynamic_rendering: true,
            labels: true,
            limits,
            memory,
            memory_blocks: Default::default(),
            pipeline_cache: None,
        };
        // SAFETY: the description is correct, and hosts drop their device last.
        unsafe { Device::from_external(external) }
    }

    /// Records and submits commands without waiting.
    pub fn submit<T>(&self, body: impl FnOnce(vk::CommandBuffer) -> Result<T>) -> Result<(Submitted, T)> {
        // SAFETY: the command buffer is fully recorded, and freed once its fence is signalled.
        unsafe {
            let buffer =
                vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
            let cmd = self.device.allocate_command_buffers(&buffer)?[0];
            let once =
                vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            self.device.begin_command_buffer(cmd, &once)?;
            let made = body(cmd);
            self.device.end_command_buffer(cmd)?;
            let fence = self.device.create_fence(&vk::FenceCreateInfo::default(), None)?;
            let commands = [cmd];
            let submit = [vk::SubmitInfo::default().command_buffers(&commands)];
            self.device.queue_submit(self.queue, &submit, fence)?;
            let submitted = Submitted { cmd, fence };
            match made {
                Ok(made) => Ok((submitted, made)),
                Err(error) => self.wait(submitted).and(Err(error)),
            }
        }
    }

    /// Records commands without submitting them.
    pub fn record<T>(&self, body: impl FnOnce(vk::CommandBuffer) -> Result<T>) -> Result<T> {
        // SAFETY: the command buffer is fully recorded, and freed.
        unsafe {
            let buffer =
                vk::CommandBufferAllocateInfo::default().command_pool(self.pool).command_buffer_count(1);
            let cmd = self.device.allocate_command_buffers(&buffer)?[0];
            self.device.begin_command_buffer(cmd, &Default::default())?;
            let made = body(cmd);
            self.device.end_command_buffer(cmd)?;
            self.device.free_command_buffers(self.pool, &[cmd]);
            made
        }
    }

    /// Records a secondary command buffer inside a pass; the caller frees it.
    pub fn record_secondary(
        &self,
        inherited: &vk::CommandBufferInheritanceInfo<'_>,
        body: impl FnOnce(vk::CommandBuffer) -> Result<()>,
    ) -> Result<vk::CommandBuffer> {
        let buffer = vk::CommandBufferAllocateInfo::default()
            .command_pool(self.pool)
            .level(vk::CommandBufferLevel::SECONDARY)
            .command_buffer_count(1);
        let within = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::RENDER_PASS_CONTINUE)
            .inheritance_info(inherited);
        // SAFETY: the command buffer is fully recorded.
        unsafe {
            let cmd = self.device.allocate_command_buffers(&buffer)?[0];
            self.device.begin_command_buffer(cmd, &within)?;
            let made = body(cmd);
            self.device.end_command_buffer(cmd)?;
            made.map(|()| cmd)
        }
    }

    /// Frees a command buffer that the GPU has finished.
    pub fn free(&self, cmd: vk::CommandBuffer) {
        // SAFETY: by the caller; it is of this pool.
        unsafe { self.device.free_command_buffers(self.pool, &[cmd]) };
    }

    /// Whether the format supports depth attachments.
    pub fn has_depth(&self, format: vk::Format) -> bool {
        // SAFETY: the device is of the instance.
        let can = unsafe { self.instance.get_physical_device_format_properties(self.physical, format) };
        can.optimal_tiling_features.contains(vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT)
    }

    /// Waits until the GPU has executed a submission.
    pub fn wait(&self, Submitted { cmd, fence }: Submitted) -> Result<()> {
        // SAFETY: both are of this device, and unused after the wait.
        unsafe {
            self.device.wait_for_fences(&[fence], true, u64::MAX)?;
            self.device.destroy_fence(fence, None);
            self.device.free_command_buffers(self.pool, &[cmd]);
        }
        Ok(())
    }

    /// Records, submits and waits.
    pub fn run<T>(&self, body: impl FnOnce(vk::CommandBuffer) -> Result<T>) -> Result<T> {
        let (submitted, made) = self.submit(body)?;
        self.wait(submitted)?;
        Ok(made)
    }

    /// Destroys the host; an error if there were validation messages, including those about leaks.
    pub fn close(self) -> Result<()> {
        let messages = self.messages.clone();
        drop(self);
        let messages = messages.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        if messages.is_empty() { Ok(()) } else { Err(format!("validation: {}", messages.join("; ")).into()) }
    }

    /// Messages of the validation layers so far.
    pub fn messages(&self) -> Vec<String> {
        self.messages.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).clone()
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        // SAFETY: dependent objects are destroyed.
        unsafe {
            let _ = self.device.device_wait_idle();
            self.device.destroy_command_pool(self.pool, None);
            self.device.destroy_device(None);
            self.debug.destroy_debug_utils_messenger(self.messenger, None);
            self.instance.destroy_instance(None);
        }
    }
}

unsafe fn choose(instance: &ash::Instance) -> Result<(vk::PhysicalDevice, u32)> {
    // SAFETY: by the caller: the instance is alive.
    unsafe {
        for physical in instance.enumerate_physical_devices()? {
            let families = instance.get_physical_device_queue_family_properties(physical);
            let serves =
                |family: &vk::QueueFamilyProperties| family.queue_flags.contains(surfel::embed::QUEUE);
            if let Some(family) = families.iter().position(serves) {
                return Ok((physical, family as u32));
            }
        }
    }
    Err("no Vulkan device does graphics and compute".into())
}

unsafe fn create_device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    family: u32,
    enabled: &Abilities,
    more: &[&'static CStr],
) -> Result<ash::Device> {
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
    let mut names: Vec<_> = enabled.extensions().chain(more.iter().copied()).map(CStr::as_ptr).collect();
    // Extensions of this host.
    names.extend(
        [khr::dynamic_rendering::NAME, khr::depth_stencil_resolve::NAME, khr::create_renderpass2::NAME]
            .map(CStr::as_ptr),
    );
    let mut rendering = vk::PhysicalDeviceDynamicRenderingFeatures::default().dynamic_rendering(true);
    let mut features = enabled.features();
    // SAFETY: by the caller: the device is of the instance.
    let there = unsafe { instance.get_physical_device_features(physical) };
    // The tests count fragments.
    let core = features.core.occlusion_query_precise(there.occlusion_query_precise != vk::FALSE);
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&names)
        .enabled_features(&core)
        .push_next(&mut rendering);
    // SAFETY: by the caller: the device and its family are of the instance.
    Ok(unsafe { instance.create_device(physical, &features.chain(info), None)? })
}

fn messenger(messages: &Mutex<Vec<String>>) -> vk::DebugUtilsMessengerCreateInfoEXT<'_> {
    use vk::{DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type};
    vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(Type::VALIDATION | Type::PERFORMANCE)
        .pfn_user_callback(Some(collect))
        .user_data(std::ptr::from_ref(messages) as *mut c_void)
}

unsafe extern "system" fn collect(
    _severity: vk::DebugUtilsMessageSeverityFlagsEXT,
    _kind: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    messages: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the layers pass valid data, and the messenger is destroyed before the list.
    unsafe {
        let text = (*data).message_as_c_str().map(|text| text.to_string_lossy().into_owned());
        let messages = &*(messages as *const Mutex<Vec<String>>);
        messages.lock().unwrap_or_else(|poisoned| poisoned.into_inner()).push(text.unwrap_or_default());
    }
    vk::FALSE
}
