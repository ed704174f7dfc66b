//! The images that a window shows in turns.

use super::surface::Surface;
use super::{Host, Result};
use ash::{khr, vk};

/// A swapchain.
pub struct Swapchain {
    pub size: [u32; 2],
    /// Whether the window is another by now.
    pub stale: bool,
    images: Vec<vk::Image>,
    /// For each image: signalled when it may be presented.
    drawn: Vec<vk::Semaphore>,
    raw: vk::SwapchainKHR,
    loader: khr::swapchain::Device,
}

/// An image that may be drawn to once its semaphore is signalled.
#[derive(Clone, Copy)]
pub struct Acquired {
    pub image: vk::Image,
    /// To be signalled when it is drawn.
    pub drawn: vk::Semaphore,
    index: u32,
}

impl Swapchain {
    /// A swapchain for a window of `size` px, in the place of another; `None` where there is nothing to be seen. The GPU is done with the other.
    pub fn new(host: &Host, surface: &Surface, size: [u32; 2], old: Option<Self>) -> Result<Option<Self>> {
        let loader = khr::swapchain::Device::new(&host.instance, &host.device);
        let raw = old.as_ref().map_or(vk::SwapchainKHR::null(), |old| old.raw);
        let wanted = surface.wants(host, size);
        // SAFETY: a plain use of Vulkan: no other swapchain is on the surface than the one that is replaced.
        let made = wanted.and_then(|info| unsafe {
            let Some(info) = info else { return Ok(None) };
            let raw = loader.create_swapchain(&info.old_swapchain(raw), None)?;
            let images = loader.get_swapchain_images(raw)?;
            let semaphore = |_| host.device.create_semaphore(&Default::default(), None);
            let drawn = images.iter().map(semaphore).collect::<std::result::Result<_, _>>()?;
            let vk::Extent2D { width, height } = info.image_extent;
            Ok(Some(Self { size: [width, height], stale: false, images, drawn, raw, loader }))
        });
        if let Some(old) = old {
            old.destroy(host);
        }
        made
    }

    /// The next image, with `signalled` as its semaphore; `None` where the window is another by now.
    pub fn acquire(&mut self, signalled: vk::Semaphore) -> Result<Option<Acquired>> {
        // SAFETY: the semaphore is unsignalled, as what waited for it was waited for.
        let found =
            unsafe { self.loader.acquire_next_image(self.raw, u64::MAX, signalled, vk::Fence::null()) };
        let index = match found {
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => {
                self.stale = true;
                return Ok(None);
            }
            Err(error) => return Err(error.into()),
            // Not the best, but acquired.
            Ok((index, suboptimal)) => {
                self.stale |= suboptimal;
                index
            }
        };
        let (image, drawn) = (self.images[index as usize], self.drawn[index as usize]);
        Ok(Some(Acquired { image, drawn, index }))
    }

    /// Shows an image when it is drawn.
    pub fn present(&mut self, host: &Host, acquired: Acquired) -> Result<()> {
        let (chains, waits, indices) = ([self.raw], [acquired.drawn], [acquired.index]);
        let info =
            vk::PresentInfoKHR::default().swapchains(&chains).wait_semaphores(&waits).image_indices(&indices);
        // SAFETY: the image was acquired, and what draws it was submitted.
        match unsafe { self.loader.queue_present(host.queue, &info) } {
            Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => self.stale = true,
            found => self.stale |= found?,
        }
        Ok(())
    }

    /// Destroys it, once the GPU is done with it.
    pub fn destroy(self, host: &Host) {
        // SAFETY: by the caller.
        unsafe {
            self.drawn.into_iter().for_each(|semaphore| host.device.destroy_semaphore(semaphore, None));
            self.loader.destroy_swapchain(self.raw, None);
        }
    }
}
