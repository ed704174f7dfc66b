//! wgpu's device, and its import into the engine.

use crate::Result;
use ash::ext;
use std::sync::Arc;
use surfel::embed::{Abilities, ExternalDevice};
use surfel::vk::{Device, DeviceLimits};
use wgpu::hal::vulkan::Api as Vulkan;
use wgpu::{DownlevelFlags, Features};

/// The wgpu objects of this host.
pub struct Gpu {
    pub device: wgpu::Device,
    pub queue: wgpu::Queue,
    pub adapter: wgpu::Adapter,
}

/// Features of wgpu that correspond to the engine's optional features.
const INT64_ATOMICS: Features = Features::SHADER_INT64.union(Features::SHADER_INT64_ATOMIC_MIN_MAX);

/// wgpu on Vulkan, with the validation layers if they are installed.
pub fn instance() -> Result<wgpu::Instance> {
    use wgpu::hal;
    let descriptor = hal::InstanceDescriptor {
        name: "surfels in wgpu",
        // The flag DEBUG would also report messages, but names WGSL in shaders, which older layers reject.
        flags: wgpu::InstanceFlags::VALIDATION,
        memory_budget_thresholds: wgpu::MemoryBudgetThresholds::default(),
        backend_options: wgpu::BackendOptions::default(),
        telemetry: None,
        display: None,
    };
    let listening: Box<hal::vulkan::CreateInstanceCallback<'_>> = Box::new(|args| {
        // SAFETY: the entry points are loaded.
        let there = unsafe { args.entry.enumerate_instance_extension_properties(None) }.unwrap_or_default();
        let name = ext::debug_utils::NAME;
        if there.iter().any(|extension| extension.extension_name_as_c_str() == Ok(name)) {
            args.extensions.push(name);
        }
    });
    // SAFETY: the callback disables nothing; wgpu owns the instance from here on.
    unsafe {
        let made = hal::vulkan::Instance::init_with_callback(&descriptor, Some(listening))?;
        Ok(wgpu::Instance::from_hal::<Vulkan>(made))
    }
}

impl Gpu {
    /// Opens a device that can present to `surface`, if given.
    pub fn open(instance: &wgpu::Instance, surface: Option<&wgpu::Surface<'_>>) -> Result<Self> {
        let options = wgpu::RequestAdapterOptions {
            power_preference: wgpu::PowerPreference::HighPerformance,
            compatible_surface: surface,
            ..Default::default()
        };
        let adapter = pollster::block_on(instance.request_adapter(&options))?;
        let wanted = wgpu::DeviceDescriptor {
            label: Some("host"),
            // The optional features of the engine, by wgpu's names.
            required_features: adapter.features() & INT64_ATOMICS,
            required_limits: wgpu::Limits::default().using_resolution(adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&wanted))?;
        Ok(Self { device, queue, adapter })
    }

    /// Imports the device into the engine. The result, and all objects created on it, must be dropped before the device.
    pub fn external_device(&self) -> Result<Arc<Device>> {
        // SAFETY: nothing of wgpu's is destroyed, and the description of the device is correct.
        unsafe {
            let device = self.device.as_hal::<Vulkan>().ok_or("wgpu does not use Vulkan")?;
            let shared = device.shared_instance();
            let external = ExternalDevice {
                instance: shared.raw_instance(),
                physical: device.raw_physical_device(),
                device: device.raw_device(),
                queue_family: device.queue_family_index(),
                enabled: self.enabled(),
                dynamic_rendering: false,
                labels: shared.extensions().contains(&ext::debug_utils::NAME),
                limits: DeviceLimits::default(),
                memory: None,
                memory_blocks: Default::default(),
                pipeline_cache: None,
            };
            Ok(Device::from_external(external)?)
        }
    }

    /// The features that wgpu has enabled: requested ones, and those behind its downlevel flags wherever they are supported.
    fn enabled(&self) -> Abilities {
        let features = self.device.features();
        let flags = self.adapter.get_downlevel_capabilities().flags;
        Abilities {
            int64_atomics: features.contains(INT64_ATOMICS),
            fragment_writes: flags.contains(DownlevelFlags::FRAGMENT_WRITABLE_STORAGE),
            subgroup_size_control: false,
            subgroup_uniform_control_flow: false,
            independent_blend: flags.contains(DownlevelFlags::INDEPENDENT_BLEND),
        }
    }

    /// Waits until the GPU has executed all submissions, or those up to `index`.
    pub fn wait(&self, index: Option<wgpu::SubmissionIndex>) -> Result<()> {
        self.device.poll(wgpu::PollType::Wait { submission_index: index, timeout: None })?;
        Ok(())
    }
}
