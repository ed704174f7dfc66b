//! Pictures to a window: a surface, its swapchain, and two frames under way.

use super::{Host, Result};
use ash::{khr, vk};
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

/// How many frames may be under way.
pub const FRAMES_IN_FLIGHT: u32 = 2;

/// Presents to a window.
pub struct Presenter {
    surfaces: khr::surface::Instance,
    swapchains: khr::swapchain::Device,
    surface: vk::SurfaceKHR,
    format: vk::SurfaceFormatKHR,
    swapchain: Option<Swapchain>,
    slots: Vec<Slot>,
    /// Of the slot that is next.
    next: usize,
}

struct Swapchain {
    raw: vk::SwapchainKHR,
    size: [u32; 2],
    images: Vec<vk::Image>,
    /// For each image: signalled when it may be presented.
    drawn: Vec<vk::Semaphore>,
    /// Whether the window is another by now.
    stale: bool,
}

/// What a frame under way uses.
struct Slot {
    pool: vk::CommandPool,
    cmd: vk::CommandBuffer,
    acquired: vk::Semaphore,
    done: vk::Fence,
}

impl Presenter {
    /// A presenter to `window`.
    pub fn new(host: &Host, window: &Window) -> Result<Self> {
        let surfaces = khr::surface::Instance::new(&host._entry, &host.instance);
        let (display, handle) = (window.display_handle()?.as_raw(), window.window_handle()?.as_raw());
        // SAFETY: the window outlives the surface, which `destroy` destroys.
        let surface =
            unsafe { ash_window::create_surface(&host._entry, &host.instance, display, handle, None)? };
        // SAFETY: the surface is of this instance.
        let (serves, formats) = unsafe {
            (
                surfaces.get_physical_device_surface_support(host.physical, host.family, surface)?,
                surfaces.get_physical_device_surface_formats(host.physical, surface)?,
            )
        };
        let srgb = [vk::Format::B8G8R8A8_SRGB, vk::Format::R8G8B8A8_SRGB];
        let format = formats.into_iter().find(|found| serves && srgb.contains(&found.format));
        let format = format.ok_or("the device does not present sRGB to this window")?;
        let slots = (0..FRAMES_IN_FLIGHT).map(|_| Slot::new(host)).collect::<Result<_>>()?;
        let swapchains = khr::swapchain::Device::new(&host.instance, &host.device);
        Ok(Self { surfaces, swapchains, surface, format, swapchain: None, slots, next: 0 })
    }

    /// The window's size is another.
    pub fn resized(&mut self) {
        if let Some(swapchain) = &mut self.swapchain {
            swapchain.stale = true;
        }
    }

    /// Px of the next frame in a window of `size` px; `None` where there is none to be seen. When it is not the size of the frame before, the
    /// GPU is done with that.
    pub fn ready(&mut self, host: &Host, size: [u32; 2]) -> Result<Option<[u32; 2]>> {
        if self.swapchain.as_ref().is_none_or(|swapchain| swapchain.stale) {
            // SAFETY: a plain use of Vulkan.
            unsafe { host.device.device_wait_idle()? };
            self.make(host, size)?;
        }
        Ok(self.swapchain.as_ref().map(|swapchain| swapchain.size))
    }

    /// Records a frame with `body`, which leaves its picture in an image that it names, and presents that.
    pub fn present(
        &mut self,
        host: &Host,
        body: impl FnOnce(vk::CommandBuffer) -> Result<vk::Image>,
    ) -> Result<()> {
        let Some(swapchain) = &mut self.swapchain else { return Ok(()) };
        let slot = &self.slots[self.next];
        // SAFETY: what the slot's last frame used is waited for; semaphores are signalled and waited for in turns, an image's after it was
        // acquired again.
        unsafe {
            host.device.wait_for_fences(&[slot.done], true, u64::MAX)?;
            let acquired =
                self.swapchains.acquire_next_image(swapchain.raw, u64::MAX, slot.acquired, vk::Fence::null());
            let index = match acquired {
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                    swapchain.stale = true;
                    return Ok(());
                }
                // Not the best, but acquired.
                found => found.map(|(index, suboptimal)| {
                    swapchain.stale |= suboptimal;
                    index
                })?,
            };
            let (image, drawn) = (swapchain.images[index as usize], swapchain.drawn[index as usize]);
            host.device.reset_command_pool(slot.pool, vk::CommandPoolResetFlags::empty())?;
            let once =
                vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
            host.device.begin_command_buffer(slot.cmd, &once)?;
            let picture = body(slot.cmd)?;
            blit(host, slot.cmd, [picture, image], swapchain.size);
            host.device.end_command_buffer(slot.cmd)?;
            slot.submit(host, drawn)?;
            let (chains, waits, indices) = ([swapchain.raw], [drawn], [index]);
            let info = vk::PresentInfoKHR::default()
                .swapchains(&chains)
                .wait_semaphores(&waits)
                .image_indices(&indices);
            match self.swapchains.queue_present(host.queue, &info) {
                Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => swapchain.stale = true,
                found => swapchain.stale |= found?,
            }
        }
        self.next = (self.next + 1) % self.slots.len();
        Ok(())
    }

    /// Makes a swapchain in the place of the one that there is; none where the window has no extent. The GPU is done with that.
    fn make(&mut self, host: &Host, size: [u32; 2]) -> Result<()> {
        let old = self.swapchain.take();
        let raw = old.as_ref().map_or(vk::SwapchainKHR::null(), |old| old.raw);
        let made = self.swapchain_of(host, size, raw);
        if let Some(old) = old {
            old.destroy(host, &self.swapchains);
        }
        self.swapchain = made?;
        Ok(())
    }

    fn swapchain_of(&self, host: &Host, size: [u32; 2], old: vk::SwapchainKHR) -> Result<Option<Swapchain>> {
        // SAFETY: a plain use of Vulkan: the surface is alive, and no other swapchain is on it than the one that is replaced.
        unsafe {
            let can = self.surfaces.get_physical_device_surface_capabilities(host.physical, self.surface)?;
            let [least, most, now] = [can.min_image_extent, can.max_image_extent, can.current_extent];
            let free = now.width == u32::MAX;
            let width = if free { size[0].clamp(least.width, most.width) } else { now.width };
            let height = if free { size[1].clamp(least.height, most.height) } else { now.height };
            if width == 0 || height == 0 {
                return Ok(None);
            }
            if !can.supported_usage_flags.contains(vk::ImageUsageFlags::TRANSFER_DST) {
                return Err("pictures cannot be copied to this window".into());
            }
            let images = can.min_image_count + 1;
            let images = if can.max_image_count == 0 { images } else { images.min(can.max_image_count) };
            let info = vk::SwapchainCreateInfoKHR::default()
                .surface(self.surface)
                .min_image_count(images)
                .image_format(self.format.format)
                .image_color_space(self.format.color_space)
                .image_extent(vk::Extent2D { width, height })
                .image_array_layers(1)
                .image_usage(vk::ImageUsageFlags::TRANSFER_DST)
                .pre_transform(can.current_transform)
                .composite_alpha(vk::CompositeAlphaFlagsKHR::OPAQUE)
                .present_mode(vk::PresentModeKHR::FIFO)
                .clipped(true)
                .old_swapchain(old);
            let raw = self.swapchains.create_swapchain(&info, None)?;
            let images = self.swapchains.get_swapchain_images(raw)?;
            let semaphore = |_| host.device.create_semaphore(&Default::default(), None);
            let drawn = images.iter().map(semaphore).collect::<std::result::Result<_, _>>()?;
            Ok(Some(Swapchain { raw, size: [width, height], images, drawn, stale: false }))
        }
    }

    /// Destroys it, before the window.
    pub fn destroy(mut self, host: &Host) {
        // SAFETY: nothing is under way after the wait.
        unsafe {
            let _ = host.device.device_wait_idle();
            if let Some(swapchain) = self.swapchain.take() {
                swapchain.destroy(host, &self.swapchains);
            }
            for slot in self.slots.drain(..) {
                host.device.destroy_command_pool(slot.pool, None);
                host.device.destroy_semaphore(slot.acquired, None);
                host.device.destroy_fence(slot.done, None);
            }
            self.surfaces.destroy_surface(self.surface, None);
        }
    }
}

impl Swapchain {
    fn destroy(self, host: &Host, swapchains: &khr::swapchain::Device) {
        // SAFETY: by the caller, nothing is under way.
        unsafe {
            self.drawn.into_iter().for_each(|semaphore| host.device.destroy_semaphore(semaphore, None));
            swapchains.destroy_swapchain(self.raw, None);
        }
    }
}

impl Slot {
    fn new(host: &Host) -> Result<Self> {
        let signalled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
        let pool = vk::CommandPoolCreateInfo::default().queue_family_index(host.family);
        // SAFETY: a plain use of Vulkan; `Presenter::destroy` destroys what is made.
        unsafe {
            let pool = host.device.create_command_pool(&pool, None)?;
            let buffer = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
            let cmd = host.device.allocate_command_buffers(&buffer)?[0];
            let acquired = host.device.create_semaphore(&Default::default(), None)?;
            Ok(Self { pool, cmd, acquired, done: host.device.create_fence(&signalled, None)? })
        }
    }

    /// Submits what was recorded, once the image is there, which is then drawn.
    unsafe fn submit(&self, host: &Host, drawn: vk::Semaphore) -> Result<()> {
        let (commands, waits, signals) = ([self.cmd], [self.acquired], [drawn]);
        let submit = [vk::SubmitInfo::default()
            .command_buffers(&commands)
            .wait_semaphores(&waits)
            .wait_dst_stage_mask(&[vk::PipelineStageFlags::TRANSFER])
            .signal_semaphores(&signals)];
        // SAFETY: by the caller: the command buffer was recorded whole, and the fence was waited for.
        unsafe {
            host.device.reset_fences(&[self.done])?;
            Ok(host.device.queue_submit(host.queue, &submit, self.done)?)
        }
    }
}

/// Copies a picture, ready to be copied, to an image that is then ready to be presented.
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
    // The wait for the image, and the one before it is presented, stand at this stage.
    let stage = vk::PipelineStageFlags::TRANSFER;
    let none = vk::DependencyFlags::empty();
    // SAFETY: by the caller.
    unsafe { host.device.cmd_pipeline_barrier(cmd, stage, stage, none, &[], &[], &[barrier]) };
}
