//! Presentation to a window, with two frames in flight.

use super::demo::FRAMES_IN_FLIGHT;
use super::surface::Surface;
use super::swapchain::Swapchain;
use super::{Host, Result};
use ash::vk;
use winit::window::Window;

/// Presents to a window.
pub struct Presenter {
    surface: Surface,
    swapchain: Option<Swapchain>,
    slots: Vec<Slot>,
    /// Index of the next slot.
    next: usize,
}

/// Resources of a frame in flight.
struct Slot {
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    acquired: vk::Semaphore,
    done: vk::Fence,
}

impl Presenter {
    /// Creates a presenter for `window`.
    pub fn new(host: &Host, window: &Window) -> Result<Self> {
        let slots = (0..FRAMES_IN_FLIGHT).map(|_| Slot::new(host)).collect::<Result<_>>()?;
        Ok(Self { surface: Surface::new(host, window)?, swapchain: None, slots, next: 0 })
    }

    /// Notes that the window's size may have changed.
    pub fn resized(&mut self) {
        if let Some(swapchain) = &mut self.swapchain {
            swapchain.stale = true;
        }
    }

    /// Size of the next frame in a window of `size` px; `None` if the window has no extent. If it differs from the last frame's, the GPU
    /// has finished that one.
    pub fn ready(&mut self, host: &Host, size: [u32; 2]) -> Result<Option<[u32; 2]>> {
        if self.swapchain.as_ref().is_none_or(|swapchain| swapchain.stale) {
            // SAFETY: plain Vulkan.
            unsafe { host.device.device_wait_idle()? };
            self.swapchain = Swapchain::new(host, &self.surface, size, self.swapchain.take())?;
        }
        Ok(self.swapchain.as_ref().map(|swapchain| swapchain.size))
    }

    /// Records a frame with `body`, which leaves the image that it returns as a transfer source, and presents it; returns whether there was
    /// an image.
    pub fn present(
        &mut self,
        host: &Host,
        body: impl FnOnce(vk::CommandBuffer) -> Result<vk::Image>,
    ) -> Result<bool> {
        let Some(swapchain) = &mut self.swapchain else { return Ok(false) };
        let slot = &self.slots[self.next];
        slot.wait(host)?;
        let Some(acquired) = swapchain.acquire(slot.acquired)? else { return Ok(false) };
        slot.record(host, acquired.image, swapchain.size, body)?;
        // SAFETY: it is fully recorded, and the slot's last frame is over.
        unsafe { slot.submit(host, acquired.drawn)? };
        self.next = (self.next + 1) % self.slots.len();
        swapchain.present(host, acquired)?;
        Ok(true)
    }

    /// Destroys the presenter, before the window.
    pub fn destroy(self, host: &Host) {
        // SAFETY: plain Vulkan; afterwards nothing is in flight.
        let _ = unsafe { host.device.device_wait_idle() };
        if let Some(swapchain) = self.swapchain {
            swapchain.destroy(host);
        }
        self.slots.into_iter().for_each(|slot| slot.destroy(host));
        self.surface.destroy();
    }
}

impl Slot {
    fn new(host: &Host) -> Result<Self> {
        let signalled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        let pool = vk::CommandPoolCreateInfo::default().queue_family_index(host.family);
        // SAFETY: plain Vulkan; `Presenter::destroy` destroys the objects.
        unsafe {
            let pool = host.device.create_command_pool(&pool, None)?;
            let buffer = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
            let cmd = host.device.allocate_command_buffers(&buffer)?[0];
            let acquired = host.device.create_semaphore(&Default::default(), None)?;
            Ok(Self { pool, cmd, acquired, done: host.device.create_fence(&signalled, None)? })
        }
    }

    /// Waits until the slot's last frame is over.
    fn wait(&self, host: &Host) -> Result<()> {
        // SAFETY: the fence is of this device.
        unsafe { host.device.wait_for_fences(&[self.done], true, u64::MAX)? };
        Ok(())
    }

    /// Records the copy of a picture that `body` leaves as a transfer source to an image of `size` px.
    fn record(
        &self,
        host: &Host,
        to: vk::Image,
        size: [u32; 2],
        body: impl FnOnce(vk::CommandBuffer) -> Result<vk::Image>,
    ) -> Result<()> {
        let once = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the slot's last frame is over, and the images have this size.
        unsafe {
            host.device.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty())?;
            host.device.begin_command_buffer(self.cmd, &once)?;
            let from = body(self.cmd)?;
            blit(host, self.cmd, [from, to], size);
            Ok(host.device.end_command_buffer(self.cmd)?)
        }
    }

    /// Destroys the slot, once its last frame is over.
    fn destroy(self, host: &Host) {
        // SAFETY: by the caller.
        unsafe {
            host.device.destroy_command_pool(self.pool, None);
            host.device.destroy_semaphore(self.acquired, None);
            host.device.destroy_fence(self.done, None);
        }
    }

    /// Submits the frame once the image is available, and signals `drawn`.
    unsafe fn submit(&self, host: &Host, drawn: vk::Semaphore) -> Result<()> {
        let (commands, waits, signals) = ([self.cmd], [self.acquired], [drawn]);
        let submit = [vk::SubmitInfo::default()
            .command_buffers(&commands)
            .wait_semaphores(&waits)
            .wait_dst_stage_mask(&[vk::PipelineStageFlags::TRANSFER])
            .signal_semaphores(&signals)];
        // SAFETY: by the caller: the command buffer is fully recorded, and the fence was waited for.
        unsafe {
            host.device.reset_fences(&[self.done])?;
            Ok(host.device.queue_submit(host.queue, &submit, self.done)?)
        }
    }
}

/// Copies a picture, a transfer source, to an image, which can then be presented.
unsafe fn blit(host: &Host, cmd: vk::CommandBuffer, [from, to]: [vk::Image; 2], size: [u32; 2]) {
    use vk::ImageLayout as Layout;
    let layers = vk::ImageSubresourceLayers {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        layer_count: 1,
        ..Default::default()
    };
    let [x, y] = size.map(|side| side as i32);
    let corners = [vk::Offset3D::default(), vk::Offset3D { x, y, z: 1 }];
    let region = vk::ImageBlit::default()
        .src_subresource(layers)
        .src_offsets(corners)
        .dst_subresource(layers)
        .dst_offsets(corners);
    let layouts = [Layout::TRANSFER_SRC_OPTIMAL, Layout::TRANSFER_DST_OPTIMAL];
    // SAFETY: by the caller: recorded outside a render pass, and both images have this size.
    unsafe {
        transition(host, cmd, to, [Layout::UNDEFINED, layouts[1]]);
        host.device.cmd_blit_image(cmd, from, layouts[0], to, layouts[1], &[region], vk::Filter::NEAREST);
        transition(host, cmd, to, [layouts[1], Layout::PRESENT_SRC_KHR]);
    }
}

unsafe fn transition(
    host: &Host,
    cmd: vk::CommandBuffer,
    image: vk::Image,
    [from, to]: [vk::ImageLayout; 2],
) {
    let range = vk::ImageSubresourceRange {
        aspect_mask: vk::ImageAspectFlags::COLOR,
        level_count: 1,
        layer_count: 1,
        ..Default::default()
    };
    let barrier = vk::ImageMemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .dst_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .old_layout(from)
        .new_layout(to)
        .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
        .image(image)
        .subresource_range(range);
    // The waits for the image and for the picture are at this stage.
    let stage = vk::PipelineStageFlags::TRANSFER;
    let none = vk::DependencyFlags::empty();
    // SAFETY: by the caller.
    unsafe { host.device.cmd_pipeline_barrier(cmd, stage, stage, none, &[], &[], &[barrier]) };
}
