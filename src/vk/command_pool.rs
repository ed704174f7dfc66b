//! A command pool for code that records and submits with raw Vulkan handles.

use super::Device;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// A command pool of the device's queue family.
pub struct CommandPool {
    raw: vk::CommandPool,
    device: Arc<Device>,
}

impl CommandPool {
    /// Creates an empty pool. Returns an error on an external device.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let (_, family) = device.queue()?;
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(family);
        // SAFETY: the family is the device's; the pool is destroyed in `drop`.
        let raw = unsafe { device.raw.create_command_pool(&info, None) };
        Ok(Self { raw: raw.map_err(Error::vulkan("vkCreateCommandPool"))?, device: device.clone() })
    }

    /// The Vulkan handle.
    pub fn handle(&self) -> vk::CommandPool {
        self.raw
    }
}

impl Drop for CommandPool {
    fn drop(&mut self) {
        // A lost device has nothing left to wait for.
        let _ = self.device.wait_idle();
        // SAFETY: nothing of it is under way.
        unsafe { self.device.raw.destroy_command_pool(self.raw, None) };
    }
}
