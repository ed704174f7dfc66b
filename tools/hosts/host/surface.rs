//! Window surfaces.

use super::{Host, Result};
use ash::{khr, vk};
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

/// The surface of a window.
pub struct Surface {
    pub raw: vk::SurfaceKHR,
    /// An sRGB format, which encodes linear light.
    pub format: vk::SurfaceFormatKHR,
    loader: khr::surface::Instance,
}

impl Surface {
    /// Creates the surface of `window`, which must outlive it.
    pub fn new(host: &Host, window: &Window) -> Result<Self> {
        let loader = khr::surface::Instance::new(&host._entry, &host.instance);
        let (display, handle) = (window.display_handle()?.as_raw(), window.window_handle()?.as_raw());
        // SAFETY: the window outlives the surface, which `destroy` destroys.
        let raw = unsafe { ash_window::create_surface(&host._entry, &host.instance, display, handle, None)? };
        // SAFETY: the surface is of this instance.
        let (serves, formats) = unsafe {
            (
                loader.get_physical_device_surface_support(host.physical, host.family, raw)?,
                loader.get_physical_device_surface_formats(host.physical, raw)?,
            )
        };
        let srgb = [vk::Format::B8G8R8A8_SRGB, vk::Format::R8G8B8A8_SRGB];
        let format = formats.into_iter().find(|found| serves && srgb.contains(&found.format));
        let format = format.ok_or("the device does not present sRGB to this window")?;
        Ok(Self { raw, format, loader })
    }

    /// Parameters of a swapchain in a window of `size` px; `None` if the window has no extent.
    pub fn wants(&self, host: &Host, size: [u32; 2]) -> Result<Option<vk::SwapchainCreateInfoKHR<'static>>> {
        // SAFETY: the surface is alive.
        let can = unsafe { self.loader.get_physical_device_surface_capabilities(host.physical, self.raw)? };
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
            .surface(self.raw)
            .min_image_count(images)
            .image_format(self.format.format)
            .image_color_space(self.format.color_space)
            .image_extent(vk::Extent2D { width, height })
            .image_array_layers(1)
            .image_usage(vk::ImageUsageFlags::TRANSFER_DST)
            .pre_transform(can.current_transform)
            .composite_alpha(vk::CompositeAlphaFlagsKHR::OPAQUE)
            .present_mode(vk::PresentModeKHR::FIFO)
            .clipped(true);
        Ok(Some(info))
    }

    /// Destroys the surface, after its swapchain and before the window.
    pub fn destroy(self) {
        // SAFETY: by the caller.
        unsafe { self.loader.destroy_surface(self.raw, None) };
    }
}
