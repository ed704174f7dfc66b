//! Window surfaces.

use super::Device;
use super::instance::Instance;
use crate::error::{Error, Result};
use ash::{khr, vk};
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use std::ffi::{CStr, c_char};
use std::sync::Arc;

/// A window to which frames can be presented.
pub trait Window: HasWindowHandle + HasDisplayHandle + Send + Sync {}

impl<W: HasWindowHandle + HasDisplayHandle + Send + Sync> Window for W {}

/// The surface of a window. It keeps the window alive.
pub struct Surface {
    pub(super) raw: vk::SurfaceKHR,
    pub(super) loader: khr::surface::Instance,
    // Dropped after the surface: the instance and the window.
    instance: Arc<Instance>,
    _window: Arc<dyn Window>,
}

/// Device extensions for presentation.
pub(super) const DEVICE_EXTENSIONS: [&CStr; 1] = [khr::swapchain::NAME];

/// Instance extensions for presentation to `window`.
pub(super) fn instance_extensions(window: &dyn Window) -> Result<&'static [*const c_char]> {
    let display = window.display_handle().map_err(no_window)?;
    ash_window::enumerate_required_extensions(display.as_raw()).map_err(no_window)
}

fn no_window(cause: impl std::fmt::Display) -> Error {
    Error::NoWindow(format!("presentation is not possible: {cause}"))
}

impl Surface {
    /// Creates the surface of `window`. `instance` has the [`instance_extensions`].
    pub(super) fn new(instance: &Arc<Instance>, window: Arc<dyn Window>) -> Result<Self> {
        let display = window.display_handle().map_err(no_window)?.as_raw();
        let handle = window.window_handle().map_err(no_window)?.as_raw();
        // SAFETY: the handles are the window's, which is kept for longer than the surface; that is destroyed in `drop`.
        let raw =
            unsafe { ash_window::create_surface(&instance.entry, &instance.raw, display, handle, None) };
        let loader = khr::surface::Instance::new(&instance.entry, &instance.raw);
        Ok(Self { raw: raw.map_err(no_window)?, loader, instance: instance.clone(), _window: window })
    }

    /// Whether `device` was opened for this surface.
    pub(super) fn is_of(&self, device: &Device) -> bool {
        device.instance().handle() == self.instance.raw.handle()
    }

    /// Whether a queue family of a device presents to the surface.
    pub(super) fn is_served_by(&self, physical: vk::PhysicalDevice, family: u32) -> bool {
        // SAFETY: the device is of the surface's instance, and the family one of its own.
        let served = unsafe { self.loader.get_physical_device_surface_support(physical, family, self.raw) };
        served.unwrap_or(false)
    }
}

impl Drop for Surface {
    fn drop(&mut self) {
        // SAFETY: the swapchain, which holds it, is gone; the instance is alive.
        unsafe { self.loader.destroy_surface(self.raw, None) };
    }
}
