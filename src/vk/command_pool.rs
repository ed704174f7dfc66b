//! Command pools: command buffers are allocated, begun and destroyed here.

use super::Device;
use super::labels::Labels;
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

    /// Calls `body` with the locked queue and the Vulkan handle, while no other thread begins or destroys command buffers, if labels are enabled.
    #[cfg(feature = "window")]
    pub fn submit<R>(&self, body: impl FnOnce(vk::Queue, vk::CommandPool) -> R) -> Result<R> {
        self.device.submit(|queue, _| {
            // After the queue, as in every submission and wait: in another order two threads may wait for each other.
            let _alone = self.device.labels.as_ref().map(Labels::lock);
            body(queue, self.raw)
        })
    }

    /// Allocates a command buffer that lives as long as the pool.
    pub(super) fn allocate(&self) -> Result<vk::CommandBuffer> {
        let info = vk::CommandBufferAllocateInfo::default().command_pool(self.raw).command_buffer_count(1);
        // SAFETY: the pool is the device's.
        let buffers = unsafe { self.device.raw.allocate_command_buffers(&info) };
        Ok(buffers.map_err(Error::vulkan("vkAllocateCommandBuffers"))?[0])
    }

    /// Begins to record `cmd` for one submission. Discards what was recorded into the pool's command buffers.
    ///
    /// # Safety
    /// `cmd` is of the pool, and the GPU has finished everything of the pool.
    pub(super) unsafe fn begin(&self, cmd: vk::CommandBuffer) -> Result<()> {
        let once = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        let raw = &self.device.raw;
        let _alone = self.device.labels.as_ref().map(Labels::lock);
        // SAFETY: by the caller.
        unsafe {
            raw.reset_command_pool(self.raw, vk::CommandPoolResetFlags::empty())
                .map_err(Error::vulkan("vkResetCommandPool"))?;
            raw.begin_command_buffer(cmd, &once).map_err(Error::vulkan("vkBeginCommandBuffer"))
        }
    }
}

impl Drop for CommandPool {
    fn drop(&mut self) {
        // A lost device has nothing left to wait for.
        let _ = self.device.wait_idle();
        let _alone = self.device.labels.as_ref().map(Labels::lock);
        // SAFETY: nothing of it is under way.
        unsafe { self.device.raw.destroy_command_pool(self.raw, None) };
    }
}
