//! Capture of a window's content, overlay included, to the CPU.

use super::presenter::Target;
use super::slot::Slot;
use super::{Buffer, Device, Image, ImageUse, overlay::Overlay};
use crate::error::Result;
use ash::vk;
use std::sync::Arc;

/// An offscreen image in place of the swapchain image, and the buffer that it is copied to.
pub(super) struct Capture {
    framebuffer: vk::Framebuffer,
    image: Image,
    pixels: Buffer,
    device: Arc<Device>,
}

impl Capture {
    /// Creates an image of the window's format and `size` px.
    pub(super) fn new(
        device: &Arc<Device>,
        overlay: &Overlay,
        format: vk::Format,
        size: [u32; 2],
    ) -> Result<Self> {
        let image = Image::target(device, "capture", format, size, ImageUse::Window)?;
        let [width, height] = size.map(u64::from);
        let pixels = Buffer::readback(device, "captured", 4 * width * height)?;
        let framebuffer = overlay.framebuffer(image.view, size)?;
        Ok(Self { framebuffer, image, pixels, device: device.clone() })
    }

    /// The target of the frame.
    pub(super) fn target(&self) -> Target {
        Target { image: self.image.raw, framebuffer: self.framebuffer, size: self.image.size() }
    }

    /// Records the copy to the buffer after the frame.
    pub(super) fn end(&self, slot: &Slot) {
        use vk::ImageLayout as Layout;
        slot.transition(self.image.raw, [Layout::TRANSFER_DST_OPTIMAL, Layout::TRANSFER_SRC_OPTIMAL]);
        let [width, height] = self.image.size();
        let region = vk::BufferImageCopy::default()
            .image_subresource(vk::ImageSubresourceLayers {
                aspect_mask: vk::ImageAspectFlags::COLOR,
                layer_count: 1,
                ..Default::default()
            })
            .image_extent(vk::Extent3D { width, height, depth: 1 });
        let barrier = vk::MemoryBarrier::default()
            .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
            .dst_access_mask(vk::AccessFlags::HOST_READ);
        let [copies, host] = [vk::PipelineStageFlags::TRANSFER, vk::PipelineStageFlags::HOST];
        let none = vk::DependencyFlags::empty();
        let (raw, from) = (&self.device.raw, Layout::TRANSFER_SRC_OPTIMAL);
        // SAFETY: recorded outside a render pass; the image is in this layout, and the buffer holds 4 bytes a pixel.
        unsafe {
            raw.cmd_copy_image_to_buffer(slot.cmd, self.image.raw, from, self.pixels.raw, &[region]);
            raw.cmd_pipeline_barrier(slot.cmd, copies, host, none, &[barrier], &[], &[]);
        }
    }

    /// The copied pixels. The GPU must have finished the frame.
    pub(super) fn pixels(&self) -> Vec<[u8; 4]> {
        let swapped = self.image.format == vk::Format::B8G8R8A8_SRGB;
        let pixels =
            self.pixels.bytes().chunks_exact(4).map(|pixel| [pixel[0], pixel[1], pixel[2], pixel[3]]);
        pixels.map(|[r, g, b, a]| if swapped { [b, g, r, a] } else { [r, g, b, a] }).collect()
    }
}

impl Drop for Capture {
    fn drop(&mut self) {
        // SAFETY: the GPU has finished the frame, or is lost.
        unsafe { self.device.raw.destroy_framebuffer(self.framebuffer, None) };
    }
}
