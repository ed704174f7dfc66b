//! Presentation to a window: a swapchain that follows the window's size, and two frames in flight.

use super::{
    Access, Commands, Device, Image, ImageUse, Recorder, Surface, capture::Capture, image::whole,
    overlay::Overlay, slot::Slot, swapchain::Swapchain,
};
use crate::error::{Error, Result};
use ash::{khr, vk};
use std::cell::RefCell;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Consecutive failures to create a swapchain that are tolerated: the window may have changed since its size was queried.
const REFUSALS: u32 = 100;

/// Number of frames in flight.
pub const FRAMES_IN_FLIGHT: u32 = 2;

/// Presents frames to a window.
pub struct Presenter {
    // Drop order: the surface goes last.
    swapchain: Option<Swapchain>,
    overlay: Overlay,
    slots: Vec<Slot>,
    /// Index of the next slot.
    next: usize,
    /// Unique id of the presenter, and the number of frames so far.
    number: u64,
    frames: u64,
    /// Whether the last frame was not presented.
    behind: bool,
    /// Consecutive failures to create a swapchain.
    refused: u32,
    /// The error of the first frame that was not submitted.
    failure: Option<String>,
    swapchains: khr::swapchain::Device,
    format: vk::SurfaceFormatKHR,
    modes: Vec<vk::PresentModeKHR>,
    surface: Surface,
    device: Arc<Device>,
}

/// A frame that is being recorded. It is submitted after all earlier frames.
pub struct Presented {
    /// The command buffer, recording outside a render pass.
    pub(crate) cmd: vk::CommandBuffer,
    /// The swapchain image, in `TRANSFER_DST_OPTIMAL` before and after the frame.
    pub(super) image: vk::Image,
    framebuffer: vk::Framebuffer,
    overlay: vk::RenderPass,
    size: [u32; 2],
    format: vk::Format,
    /// Number of the frame among those of its presenter, and the id of the presenter.
    pub(crate) number: u64,
    pub(crate) presenter: u64,
    /// Stakes of those that recorded into the frame.
    stakes: RefCell<Vec<Arc<Stake>>>,
    device: Arc<Device>,
}

/// Shared state of a frame that is being recorded and an object that records into it.
#[derive(Default)]
pub(crate) struct Stake {
    /// The commands were discarded.
    thrown: AtomicBool,
    /// A resource that the commands use was destroyed.
    gone: AtomicBool,
}

impl Stake {
    /// Whether the commands were discarded.
    pub(crate) fn is_thrown(&self) -> bool {
        self.thrown.load(Ordering::Relaxed)
    }

    /// Marks a resource as destroyed: a frame that is still being recorded is then not submitted.
    pub(crate) fn go(&self) {
        self.gone.store(true, Ordering::Relaxed);
    }
}

/// The image that a frame is drawn to.
pub(super) struct Target {
    pub(super) image: vk::Image,
    pub(super) framebuffer: vk::Framebuffer,
    pub(super) size: [u32; 2],
}

impl Presented {
    /// Width and height, px.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// The image's format: 8 bits each of sRGB and α.
    pub fn format(&self) -> vk::Format {
        self.format
    }

    /// A stake for an object that records into the frame.
    pub(crate) fn stake(&self) -> Arc<Stake> {
        let stake = Arc::new(Stake::default());
        self.stakes.borrow_mut().push(stake.clone());
        stake
    }

    /// Returns an error if the recorded commands use a destroyed resource.
    pub(super) fn check(&self) -> Result<()> {
        if self.stakes.borrow().iter().any(|stake| stake.gone.load(Ordering::Relaxed)) {
            Err(Error::Usage("an object that draws in a frame was dropped while the frame was recorded: keep it until the frame is presented".into()))
        } else {
            Ok(())
        }
    }

    /// Marks the commands as discarded.
    pub(super) fn throw(&self) {
        self.stakes.borrow().iter().for_each(|stake| stake.thrown.store(true, Ordering::Relaxed));
    }

    /// Clears the image to black.
    pub fn clear(&self) {
        let range = whole(vk::ImageAspectFlags::COLOR);
        let black = vk::ClearColorValue { float32: [0.0, 0.0, 0.0, 1.0] };
        let layout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;
        let before = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::TRANSFER_WRITE);
        let (copies, none) = (vk::PipelineStageFlags::TRANSFER, vk::DependencyFlags::empty());
        // SAFETY: the command buffer is being recorded outside a render pass, and the image is in this layout.
        unsafe {
            let raw = &self.device.raw;
            raw.cmd_clear_color_image(self.cmd, self.image, layout, &black, &[range]);
            raw.cmd_pipeline_barrier(self.cmd, copies, copies, none, &[before], &[], &[]);
        }
    }

    /// A recorder for passes of the frame.
    pub fn recorder(&self) -> Recorder<'_> {
        // SAFETY: the presenter submits what is being recorded before what is recorded later, to one queue; nothing else is recorded inside
        // `over`, which has the frame for itself.
        unsafe { Recorder::of_host(&self.device, self.cmd) }
    }

    /// Draws over the image: calls `body` with the command buffer inside the render pass [`Presenter::overlay`].
    pub fn over(&mut self, label: &'static str, body: impl FnOnce(vk::CommandBuffer)) {
        let [width, height] = self.size;
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(self.overlay)
            .framebuffer(self.framebuffer)
            .render_area(vk::Rect2D {
                offset: vk::Offset2D::default(),
                extent: vk::Extent2D { width, height },
            });
        // SAFETY: the command buffer is being recorded outside a render pass; begin and end pair.
        unsafe {
            self.device.begin_label(self.cmd, label);
            self.device.raw.cmd_begin_render_pass(self.cmd, &info, vk::SubpassContents::INLINE);
            body(self.cmd);
            self.device.raw.cmd_end_render_pass(self.cmd);
            self.device.end_label(self.cmd);
        }
    }
}

/// A unique presenter id.
fn next_number() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

impl Presenter {
    /// Presents with `device`, which [`Device::open_for`] returned together with `surface`.
    pub fn new(device: &Arc<Device>, surface: Surface) -> Result<Self> {
        if !surface.is_of(device) {
            let message =
                "the surface is of another device: use the one that Device::open_for returned with it";
            return Err(Error::Usage(message.into()));
        }
        let physical = device.physical();
        // SAFETY: the surface is of the device's instance.
        let (formats, modes) = unsafe {
            let formats = surface.loader.get_physical_device_surface_formats(physical, surface.raw);
            let modes = surface.loader.get_physical_device_surface_present_modes(physical, surface.raw);
            (
                formats.map_err(Error::vulkan("vkGetPhysicalDeviceSurfaceFormatsKHR"))?,
                modes.map_err(Error::vulkan("vkGetPhysicalDeviceSurfacePresentModesKHR"))?,
            )
        };
        let encodes = [vk::Format::B8G8R8A8_SRGB, vk::Format::R8G8B8A8_SRGB];
        let format = formats.iter().find(|found| encodes.contains(&found.format)).copied();
        let format = format.ok_or_else(|| {
            let name = &device.description().name;
            Error::NoDevice(format!(
                "{name} does not present 8-bit sRGB to this window, only {formats:?}: choose another device"
            ))
        })?;
        let slots = (0..FRAMES_IN_FLIGHT).map(|_| Slot::new(device)).collect::<Result<_>>()?;
        let overlay = Overlay::new(device, format.format)?;
        let swapchains = khr::swapchain::Device::new(device.instance(), &device.raw);
        Ok(Self {
            swapchain: None,
            overlay,
            slots,
            next: 0,
            number: next_number(),
            frames: 0,
            behind: false,
            refused: 0,
            failure: None,
            swapchains,
            format,
            modes,
            surface,
            device: device.clone(),
        })
    }

    /// The device that presents.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// The format of the window's images: 8 bits each of sRGB and α.
    pub fn format(&self) -> vk::Format {
        self.format.format
    }

    /// The presenter's unique id.
    pub(crate) fn number(&self) -> u64 {
        self.number
    }

    /// The render pass in which [`Presented::over`] draws: one colour attachment with an sRGB format.
    pub fn overlay(&self) -> vk::RenderPass {
        self.overlay.raw
    }

    /// Notes that the window's size may have changed.
    pub fn resized(&mut self) {
        if let Some(swapchain) = &mut self.swapchain {
            swapchain.stale = true;
        }
    }

    /// Scales an image of the window's format once, so that a driver which compiles a shader for the first blit does so now. Some drivers
    /// compile another one for power-of-two sizes: these sizes are not.
    pub fn rehearse(&self) -> Result<()> {
        let target = |size, also| Image::target(&self.device, "rehearsed", self.format.format, size, also);
        let from = target([3, 3], ImageUse::Output)?;
        let to = target([5, 5], ImageUse::Window)?;
        Commands::new(&self.device, false)?.run(|rec| {
            let uses = [from.with(Access::COPY_READ), to.with(Access::SCALE_WRITE)];
            rec.pass("rehearse", &uses).scale(&from, (to.raw, to.size()), [0.0, 1.0]);
        })
    }

    /// Whether the window does not show the last frame: it has no extent, or has changed since. A later frame may be presented without any
    /// window event.
    pub fn is_behind(&self) -> bool {
        self.behind
    }

    /// Records a frame with `record` and presents it in a window of `size` px; `None` if the window has no extent. Before `record` is
    /// called, the GPU has finished all but the last [`FRAMES_IN_FLIGHT`] − 1 frames.
    ///
    /// After an error of `record` the frame is empty, and the next frame can be presented.
    pub fn present<R>(
        &mut self,
        size: [u32; 2],
        record: impl FnOnce(&mut Presented) -> Result<R>,
    ) -> Result<Option<R>> {
        self.check()?;
        self.behind = true;
        let Some(index) = self.acquire(size)? else { return Ok(None) };
        let Some(target) = self.swapchain.as_ref().map(|swapchain| swapchain.target(index)) else {
            return Ok(None);
        };
        let image = target.image;
        let frame = self.frame(target);
        let Some(swapchain) = &mut self.swapchain else { return Ok(None) };
        let slot = &mut self.slots[self.next];
        use vk::ImageLayout as Layout;
        let recorded = slot.record(frame, record, |slot| {
            slot.transition(image, [Layout::TRANSFER_DST_OPTIMAL, Layout::PRESENT_SRC_KHR]);
        });
        let submitted = recorded.and_then(|made| slot.submit(Some(swapchain.drawn(index))).map(|()| made));
        let recorded = submitted.inspect_err(|error| self.failure = Some(error.to_string()))?;
        self.next = (self.next + 1) % self.slots.len();
        self.behind = !swapchain.present(&self.device, index)?;
        recorded.map(Some)
    }

    /// The next frame, in the next slot.
    fn frame(&mut self, Target { image, framebuffer, size }: Target) -> Presented {
        self.frames += 1;
        Presented {
            cmd: self.slots[self.next].cmd,
            image,
            framebuffer,
            overlay: self.overlay.raw,
            size,
            format: self.format.format,
            number: self.frames,
            presenter: self.number,
            stakes: RefCell::default(),
            device: self.device.clone(),
        }
    }

    /// Waits for the next slot and acquires an image of a swapchain that fits the window; `None` if the window has no extent.
    fn acquire(&mut self, size: [u32; 2]) -> Result<Option<usize>> {
        // The window may change between any two calls: one retry now, then again with the next frame.
        for _ in 0..2 {
            if self.swapchain.as_ref().is_none_or(|swapchain| swapchain.stale || swapchain.asked != size) {
                self.remake(size)?;
            }
            let Some(swapchain) = &mut self.swapchain else { return Ok(None) };
            let slot = &self.slots[self.next];
            slot.wait()?;
            if let Some(index) = swapchain.acquire(slot.acquired)? {
                return Ok(Some(index));
            }
        }
        Ok(None)
    }

    /// Records a frame of `size` px as [`Presenter::present`] does, but returns its pixels: sRGB and α, 8 bits each, row by row from the
    /// top left. Waits for the GPU.
    pub fn capture(
        &mut self,
        size: [u32; 2],
        record: impl FnOnce(&mut Presented) -> Result<()>,
    ) -> Result<Vec<[u8; 4]>> {
        self.check()?;
        self.wait()?;
        let capture = Capture::new(&self.device, &self.overlay, self.format.format, size)?;
        let frame = self.frame(capture.target());
        let slot = &mut self.slots[self.next];
        let recorded = slot.record(frame, record, |slot| capture.end(slot));
        let submitted = recorded.and_then(|made| slot.submit(None).map(|()| made));
        let recorded = submitted.inspect_err(|error| self.failure = Some(error.to_string()))?;
        self.slots[self.next].wait()?;
        recorded.map(|()| capture.pixels())
    }

    /// Whether frames can still be submitted: after a failed submission, the semaphore of the acquired image stays signalled.
    fn check(&self) -> Result<()> {
        let Some(failure) = &self.failure else { return Ok(()) };
        Err(Error::Usage(format!(
            "an earlier frame was not submitted: {failure}: open the device and its window again"
        )))
    }

    /// Waits until the GPU has finished every frame.
    pub fn wait(&self) -> Result<()> {
        self.slots.iter().try_for_each(Slot::wait)
    }

    /// Waits for every frame and recreates the swapchain with this size; none if the window has no extent or changed meanwhile.
    fn remake(&mut self, size: [u32; 2]) -> Result<()> {
        self.wait()?;
        // The presentation engine may still read presented images.
        self.device.wait_idle()?;
        let old = self.swapchain.take();
        let how = (&self.surface, self.format, self.mode());
        let window = (&self.swapchains, &self.overlay);
        let made = Swapchain::new(&self.device, window, how, size, old);
        let refused = made.as_ref().is_err_and(Swapchain::is_refusal);
        self.refused = if refused { self.refused + 1 } else { 0 };
        self.swapchain = if refused && self.refused < REFUSALS { None } else { made? };
        Ok(())
    }

    /// The present mode: `MAILBOX` where supported, otherwise `FIFO`.
    fn mode(&self) -> vk::PresentModeKHR {
        if self.modes.contains(&vk::PresentModeKHR::MAILBOX) {
            vk::PresentModeKHR::MAILBOX
        } else {
            vk::PresentModeKHR::FIFO
        }
    }
}

impl Drop for Presenter {
    fn drop(&mut self) {
        // A lost device has nothing left to wait for.
        let _ = self.device.wait_idle();
    }
}
