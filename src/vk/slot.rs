//! Resources of one frame in flight: a command buffer, a fence and a semaphore.

use super::Device;
use super::command_pool::CommandPool;
use super::image::whole;
use super::lock;
use super::presenter::Presented;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// One of the frames in flight.
pub(super) struct Slot {
    pool: CommandPool,
    pub(super) cmd: vk::CommandBuffer,
    /// Signalled when the swapchain image is available.
    pub(super) acquired: vk::Semaphore,
    /// Null after a failed submission: there is nothing to wait for.
    done: vk::Fence,
    device: Arc<Device>,
}

impl Slot {
    pub(super) fn new(device: &Arc<Device>) -> Result<Self> {
        let pool = CommandPool::new(device)?;
        let cmd = pool.allocate()?;
        let null = (vk::Semaphore::null(), vk::Fence::null());
        let mut slot = Self { pool, cmd, acquired: null.0, done: null.1, device: device.clone() };
        let signalled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        let raw = &device.raw;
        // SAFETY: all infos are valid; what is made is destroyed in `drop`.
        unsafe {
            let semaphore = raw.create_semaphore(&vk::SemaphoreCreateInfo::default(), None);
            slot.acquired = semaphore.map_err(Error::vulkan("vkCreateSemaphore"))?;
            slot.done = raw.create_fence(&signalled, None).map_err(Error::vulkan("vkCreateFence"))?;
        }
        Ok(slot)
    }

    /// Waits until the GPU has finished the last frame of this slot.
    pub(super) fn wait(&self) -> Result<()> {
        if self.done == vk::Fence::null() {
            return Ok(());
        }
        // SAFETY: the fence is the device's.
        unsafe { self.device.wait(self.done) }
    }

    /// Records a frame, and returns the result of `body`. After an error of `body`, only the first image transition and `end` remain. The
    /// caller has waited for the slot.
    ///
    /// # Errors
    /// Those of Vulkan, after which the command buffer must not be submitted.
    pub(super) fn record<R>(
        &self,
        mut frame: Presented,
        body: impl FnOnce(&mut Presented) -> Result<R>,
        end: impl FnOnce(&Self),
    ) -> Result<Result<R>> {
        self.begin(frame.image)?;
        let recorded = body(&mut frame).and_then(|made| frame.check().map(|()| made));
        if recorded.is_err() {
            frame.throw();
            self.begin(frame.image)?;
        }
        end(self);
        // SAFETY: it is being recorded.
        unsafe { self.device.raw.end_command_buffer(self.cmd) }
            .map_err(Error::vulkan("vkEndCommandBuffer"))?;
        Ok(recorded)
    }

    fn begin(&self, image: vk::Image) -> Result<()> {
        // SAFETY: nothing of the pool is under way.
        unsafe { self.pool.begin(self.cmd) }?;
        self.transition(image, [vk::ImageLayout::UNDEFINED, vk::ImageLayout::TRANSFER_DST_OPTIMAL]);
        Ok(())
    }

    /// Transitions the image between layouts, with a barrier between the copies to it and all other accesses.
    pub(super) fn transition(&self, image: vk::Image, [from, to]: [vk::ImageLayout; 2]) {
        let next = match to {
            vk::ImageLayout::TRANSFER_SRC_OPTIMAL => vk::AccessFlags::TRANSFER_READ,
            _ => vk::AccessFlags::TRANSFER_WRITE,
        };
        let range = whole(vk::ImageAspectFlags::COLOR);
        let barrier = vk::ImageMemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(next)
            .old_layout(from)
            .new_layout(to)
            .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
            .image(image)
            .subresource_range(range);
        // The waits for the image and for the drawing are at this stage.
        let stage = vk::PipelineStageFlags::TRANSFER;
        let none = vk::DependencyFlags::empty();
        // SAFETY: the command buffer is being recorded outside a render pass; the image is the swapchain's.
        unsafe {
            self.device.raw.cmd_pipeline_barrier(self.cmd, stage, stage, none, &[], &[], &[barrier]);
        }
    }

    /// Submits the command buffer. For a swapchain image, it waits until the image is available and then signals `drawn`. The slot cannot
    /// be submitted again after an error.
    pub(super) fn submit(&mut self, drawn: Option<vk::Semaphore>) -> Result<()> {
        let (queue, _) = self.device.queue()?;
        let (commands, stages) = ([self.cmd], [vk::PipelineStageFlags::TRANSFER]);
        let (waits, signals) = (drawn.map(|_| self.acquired), drawn);
        let submit = [vk::SubmitInfo::default()
            .command_buffers(&commands)
            .wait_semaphores(waits.as_slice())
            .wait_dst_stage_mask(&stages[..waits.as_slice().len()])
            .signal_semaphores(signals.as_slice())];
        let queue = lock(queue);
        let _alone = self.device.lock_if_validated();
        // SAFETY: the buffer was recorded whole; the fence was waited for, and the queue is locked.
        unsafe {
            let raw = &self.device.raw;
            raw.reset_fences(&[self.done]).map_err(Error::vulkan("vkResetFences"))?;
            let submitted = raw.queue_submit(*queue, &submit, self.done);
            if submitted.is_err() {
                // Nothing would ever signal it.
                raw.destroy_fence(std::mem::take(&mut self.done), None);
            }
            submitted.map_err(Error::vulkan("vkQueueSubmit"))
        }
    }
}

impl Drop for Slot {
    fn drop(&mut self) {
        // SAFETY: the presenter has waited for the device. Null handles are ignored.
        unsafe {
            self.device.raw.destroy_fence(self.done, None);
            self.device.raw.destroy_semaphore(self.acquired, None);
        }
    }
}
