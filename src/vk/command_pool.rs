//! A pool of command buffers, for who records and submits by Vulkan's own handles.

use super::Device;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// A pool for buffers that go to the device's queue.
pub struct CommandPool {
    raw: vk::CommandPool,
    device: Arc<Device>,
}

impl CommandPool {
    /// An empty pool. Refused on a device that a host lends.
    pub fn new(device: &Arc<Device>) -> Result<Self> {
        let (_, family) = device.queue()?;
        let info = vk::CommandPoolCreateInfo::default().queue_family_index(family);
        // SAFETY: the family is the device's; the pool is destroyed in `drop`.
        let raw = unsafe { device.raw.create_command_pool(&info, None) };
        Ok(Self { raw: raw.map_err(Error::vulkan("vkCreateCommandPool"))?, device: device.clone() })
    }

    /// Vulkan's own.
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
