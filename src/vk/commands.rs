//! A command buffer with its pool and fence.

use super::command_pool::CommandPool;
use super::lock;
use super::timestamps::Timestamps;
use super::{Device, PassTime, Recorder};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// A command buffer that is recorded, submitted and waited for repeatedly.
pub struct Commands {
    pool: CommandPool,
    cmd: vk::CommandBuffer,
    fence: vk::Fence,
    timestamps: Option<Timestamps>,
    timed: bool,
    /// Whether recording began without a submission.
    recording: bool,
    device: Arc<Device>,
}

impl Commands {
    /// Creates the command buffer; with `profile`, passes are timed if the device has timestamps. Returns an error on an external device.
    pub fn new(device: &Arc<Device>, profile: bool) -> Result<Self> {
        let pool = CommandPool::new(device)?;
        let cmd = pool.allocate()?;
        let timestamps = if profile { Timestamps::new(device)? } else { None };
        // SAFETY: the info is valid; the fence is destroyed in `drop`.
        let fence = unsafe { device.raw.create_fence(&vk::FenceCreateInfo::default(), None) }
            .map_err(Error::vulkan("vkCreateFence"))?;
        Ok(Self { pool, cmd, fence, timestamps, timed: profile, recording: false, device: device.clone() })
    }

    /// Enables or disables the timing of later runs, if created with `profile`: the barriers around each timed pass cost time themselves.
    pub fn time(&mut self, on: bool) {
        self.timed = on;
    }

    /// Begins recording; discards what was recorded before.
    pub fn begin(&mut self) -> Result<Recorder<'_>> {
        // SAFETY: the last submission was waited for.
        unsafe { self.pool.begin(self.cmd) }?;
        self.recording = true;
        Ok(Recorder::new(&self.device, self.cmd, self.timestamps.as_mut().filter(|_| self.timed)))
    }

    /// Submits what was recorded since [`Commands::begin`] and waits until the GPU has finished.
    pub fn submit(&mut self) -> Result<()> {
        if !std::mem::take(&mut self.recording) {
            return Ok(());
        }
        let (queue, _) = self.device.queue()?;
        let raw = &self.device.raw;
        let buffers = [self.cmd];
        let submit = [vk::SubmitInfo::default().command_buffers(&buffers)];
        // SAFETY: the buffer was begun and recorded, the fence is unsignalled, and both are waited for before they are used again.
        unsafe {
            raw.end_command_buffer(self.cmd).map_err(Error::vulkan("vkEndCommandBuffer"))?;
            {
                let queue = lock(queue);
                let _alone = self.device.lock_if_validated();
                raw.queue_submit(*queue, &submit, self.fence).map_err(Error::vulkan("vkQueueSubmit"))?;
            }
            // The commands may still run after a failed wait; a lost device has nothing left to wait for.
            let waited = self.device.wait(self.fence).inspect_err(|_| drop(self.device.wait_idle()));
            raw.reset_fences(&[self.fence]).map_err(Error::vulkan("vkResetFences"))?;
            waited
        }
    }

    /// Records with `body`, submits, and waits until the GPU has finished.
    pub fn run(&mut self, body: impl FnOnce(&mut Recorder<'_>)) -> Result<()> {
        body(&mut self.begin()?);
        self.submit()
    }

    /// Times of the passes of the last run; empty without profiling.
    pub fn pass_times(&self) -> Result<Vec<PassTime>> {
        self.timestamps.as_ref().filter(|_| self.timed).map_or(Ok(Vec::new()), Timestamps::read)
    }
}

impl Drop for Commands {
    fn drop(&mut self) {
        // A lost device has nothing left to wait for.
        let _ = self.device.wait_idle();
        // SAFETY: every run is waited for; after a failed one the device is idle or lost.
        unsafe { self.device.raw.destroy_fence(self.fence, None) };
    }
}
