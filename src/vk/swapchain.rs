//! Swapchain: the images of a window, of one size.

use super::image::whole;
use super::lock;
use super::presenter::Target;
use super::{Device, Surface, overlay::Overlay};
use crate::error::{Error, Result};
use ash::{khr, vk};
use std::sync::Arc;

const CREATE: &str = "vkCreateSwapchainKHR";
/// Frames are copied or scaled to the images, and what is drawn over them is an attachment's.
const USAGE: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::TRANSFER_DST.as_raw() | vk::ImageUsageFlags::COLOR_ATTACHMENT.as_raw(),
);

/// The swapchain of a window.
pub(super) struct Swapchain {
    raw: vk::SwapchainKHR,
    images: Vec<SwapchainImage>,
    size: [u32; 2],
    /// The window's size at creation. X11 reports a new size only later.
    pub(super) asked: [u32; 2],
    /// Whether the window has changed since.
    pub(super) stale: bool,
    loader: khr::swapchain::Device,
    device: Arc<Device>,
}

struct SwapchainImage {
    image: vk::Image,
    view: vk::ImageView,
    framebuffer: vk::Framebuffer,
    /// Signalled when drawing to the image has finished.
    drawn: vk::Semaphore,
}

impl Swapchain {
    /// Creates a swapchain for a window of `size` px in place of `old`, which is no longer in use; `None` if the window has no extent.
    pub(super) fn new(
        device: &Arc<Device>,
        (loader, overlay): (&khr::swapchain::Device, &Overlay),
        (surface, format, mode): (&Surface, vk::SurfaceFormatKHR, vk::PresentModeKHR),
        size: [u32; 2],
        old: Option<Self>,
    ) -> Result<Option<Self>> {
        // SAFETY: the surface is of the device's instance.
        let can = unsafe {
            surface.loader.get_physical_device_surface_capabilities(device.physical(), surface.raw)
        };
        let can = can.map_err(Error::vulkan("vkGetPhysicalDeviceSurfaceCapabilitiesKHR"))?;
        let extent = extent(&can, size);
        if extent.width == 0 || extent.height == 0 || size.contains(&0) {
            return Ok(None);
        }
        if !can.supported_usage_flags.contains(USAGE) {
            return Err(Error::NoDevice(format!(
                "{} cannot copy to the images of this window, or draw over them: choose another device",
                device.description().name
            )));
        }
        let count = can.min_image_count + 1;
        let count = if can.max_image_count == 0 { count } else { count.min(can.max_image_count) };
        let info = vk::SwapchainCreateInfoKHR::default()
            .surface(surface.raw)
            .min_image_count(count)
            .image_format(format.format)
            .image_color_space(format.color_space)
            .image_extent(extent)
            .image_array_layers(1)
            .image_usage(USAGE)
            .pre_transform(transform(&can))
            .composite_alpha(composite_alpha(&can))
            .present_mode(mode)
            .clipped(true)
            .old_swapchain(old.as_ref().map_or(vk::SwapchainKHR::null(), |old| old.raw));
        // SAFETY: the surface can do what is asked for, and has no other swapchain than the one that is replaced.
        let raw = unsafe { loader.create_swapchain(&info, None) }.map_err(Error::vulkan(CREATE))?;
        drop(old);
        let mut made = Self {
            raw,
            images: Vec::new(),
            size: [extent.width, extent.height],
            asked: size,
            stale: false,
            loader: loader.clone(),
            device: device.clone(),
        };
        // SAFETY: it was made just now.
        let images = unsafe { loader.get_swapchain_images(raw) };
        for image in images.map_err(Error::vulkan("vkGetSwapchainImagesKHR"))? {
            made.add(image, format.format, overlay)?;
        }
        Ok(Some(made))
    }

    /// Whether the error may come from a window that changed after its size was queried.
    pub(super) fn is_refusal(error: &Error) -> bool {
        let results = [vk::Result::ERROR_INITIALIZATION_FAILED, vk::Result::ERROR_OUT_OF_DATE_KHR];
        matches!(error, Error::Vulkan { call: CREATE, result } if results.contains(result))
    }

    fn add(&mut self, image: vk::Image, format: vk::Format, overlay: &Overlay) -> Result<()> {
        let (view, framebuffer) = (vk::ImageView::null(), vk::Framebuffer::null());
        self.images.push(SwapchainImage { image, view, framebuffer, drawn: vk::Semaphore::null() });
        let Some(shown) = self.images.last_mut() else { return Ok(()) };
        let range = whole(vk::ImageAspectFlags::COLOR);
        let info = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(range);
        let raw = &self.device.raw;
        // SAFETY: the image is the swapchain's; what is made is destroyed in `drop`.
        unsafe {
            shown.view = raw.create_image_view(&info, None).map_err(Error::vulkan("vkCreateImageView"))?;
            let semaphore = raw.create_semaphore(&vk::SemaphoreCreateInfo::default(), None);
            shown.drawn = semaphore.map_err(Error::vulkan("vkCreateSemaphore"))?;
        }
        shown.framebuffer = overlay.framebuffer(shown.view, self.size)?;
        Ok(())
    }

    /// Acquires the next image, which is available when `acquired` is signalled; `None` if the swapchain is out of date.
    pub(super) fn acquire(&mut self, acquired: vk::Semaphore) -> Result<Option<usize>> {
        // SAFETY: the semaphore is unsignalled: what waits for it was waited for.
        let found =
            unsafe { self.loader.acquire_next_image(self.raw, u64::MAX, acquired, vk::Fence::null()) };
        match found {
            // Suboptimal, but acquired: the semaphore will be signalled.
            Ok((index, suboptimal)) => {
                self.stale |= suboptimal;
                Ok(Some(index as usize))
            }
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                self.stale = true;
                Ok(None)
            }
            Err(result) => Err(Error::Vulkan { call: "vkAcquireNextImageKHR", result }),
        }
    }

    /// The target of the frame.
    pub(super) fn target(&self, index: usize) -> Target {
        let SwapchainImage { image, framebuffer, .. } = self.images[index];
        Target { image, framebuffer, size: self.size }
    }

    /// The semaphore that signals the end of drawing to the image.
    pub(super) fn drawn(&self, index: usize) -> vk::Semaphore {
        self.images[index].drawn
    }

    /// Presents the image after drawing; returns whether the swapchain still fits the window.
    pub(super) fn present(&mut self, device: &Device, index: usize) -> Result<bool> {
        let (chains, waits, indices) = ([self.raw], [self.drawn(index)], [index as u32]);
        let info =
            vk::PresentInfoKHR::default().swapchains(&chains).wait_semaphores(&waits).image_indices(&indices);
        let (queue, _) = device.queue()?;
        let queue = lock(queue);
        // SAFETY: the image was acquired, and what signals the semaphore is submitted; the queue is locked.
        match unsafe { self.loader.queue_present(*queue, &info) } {
            Ok(suboptimal) => {
                self.stale |= suboptimal;
                Ok(true)
            }
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                self.stale = true;
                Ok(false)
            }
            Err(result) => Err(Error::Vulkan { call: "vkQueuePresentKHR", result }),
        }
    }
}

/// The image extent in a window of `size` px: the surface's current extent if it has one.
fn extent(can: &vk::SurfaceCapabilitiesKHR, size: [u32; 2]) -> vk::Extent2D {
    let [least, most, own] = [can.min_image_extent, can.max_image_extent, can.current_extent];
    match own.width {
        u32::MAX => vk::Extent2D {
            width: size[0].clamp(least.width, most.width.max(least.width)),
            height: size[1].clamp(least.height, most.height.max(least.height)),
        },
        _ => own,
    }
}

/// How α of the images is composed with other windows: not at all, if the surface can leave it out.
fn composite_alpha(can: &vk::SurfaceCapabilitiesKHR) -> vk::CompositeAlphaFlagsKHR {
    use vk::CompositeAlphaFlagsKHR as Alpha;
    let kinds = [Alpha::OPAQUE, Alpha::INHERIT, Alpha::PRE_MULTIPLIED, Alpha::POST_MULTIPLIED];
    let supported = |kind: &Alpha| can.supported_composite_alpha.contains(*kind);
    kinds.into_iter().find(supported).unwrap_or(Alpha::OPAQUE)
}

/// Transform of the images relative to the display: none, where the presentation engine can rotate them itself.
fn transform(can: &vk::SurfaceCapabilitiesKHR) -> vk::SurfaceTransformFlagsKHR {
    let identity = vk::SurfaceTransformFlagsKHR::IDENTITY;
    if can.supported_transforms.contains(identity) { identity } else { can.current_transform }
}

impl Drop for Swapchain {
    fn drop(&mut self) {
        // SAFETY: the presenter has waited for the device. Null handles are ignored.
        unsafe {
            for SwapchainImage { view, framebuffer, drawn, .. } in &self.images {
                self.device.raw.destroy_framebuffer(*framebuffer, None);
                self.device.raw.destroy_image_view(*view, None);
                self.device.raw.destroy_semaphore(*drawn, None);
            }
            self.loader.destroy_swapchain(self.raw, None);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_are_not_rotated_where_the_display_can_do_that() {
        use vk::SurfaceTransformFlagsKHR as Transform;
        let of = |supported_transforms, current_transform| {
            transform(&vk::SurfaceCapabilitiesKHR {
                supported_transforms,
                current_transform,
                ..Default::default()
            })
        };
        let rotated = Transform::ROTATE_90;
        assert_eq!(of(Transform::IDENTITY | rotated, rotated), Transform::IDENTITY);
        assert_eq!(of(rotated, rotated), rotated);
    }
}
