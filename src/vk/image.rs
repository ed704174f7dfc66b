//! Render target images.

use super::Device;
use super::memory::{self, Allocation, Location, MemoryRequest};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// Use of an image beside rendering.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImageUse {
    /// Sampled by a later pass.
    Sampled,
    /// Read as an input attachment by later subpasses of the same render pass, if at all; not stored.
    Transient,
    /// Offscreen replacement of a window's image: copied to, drawn over, and copied to the CPU.
    #[cfg(feature = "window")]
    Window,
    /// The result of a frame that is drawn: copied to the CPU, or drawn over a host's target.
    Output,
    /// The result of a frame that compute shaders write: copied to the CPU, or drawn over a host's target.
    StoredOutput,
    /// A picture that is drawn, and then loaded by compute shaders.
    FilteredOutput,
    /// Cleared, written and fetched by compute shaders in parts, in `GENERAL` layout ([`super::Access::in_general`]).
    Stored,
}

impl ImageUse {
    /// Whether compute shaders load from and store to the result.
    pub fn is_stored(self) -> bool {
        matches!(self, Self::StoredOutput | Self::FilteredOutput)
    }
}

/// A two-dimensional render target with its memory and view.
pub struct Image {
    pub(super) raw: vk::Image,
    pub(super) view: vk::ImageView,
    pub(super) format: vk::Format,
    size: [u32; 2],
    allocation: Option<Allocation>,
    device: Arc<Device>,
}

/// Size of a pixel of `format`, bytes.
pub fn pixel_bytes(format: vk::Format) -> u64 {
    match format {
        vk::Format::R32G32B32A32_SFLOAT | vk::Format::R32G32B32A32_UINT => 16,
        vk::Format::R32G32B32_SFLOAT => 12,
        vk::Format::D32_SFLOAT_S8_UINT => 5,
        vk::Format::R16G16B16A16_SFLOAT | vk::Format::R32G32_SFLOAT | vk::Format::R32G32_UINT => 8,
        vk::Format::R16_SFLOAT => 2,
        _ => 4,
    }
}

impl Image {
    /// Creates a colour or depth target of `format` and `size` px.
    pub fn target(
        device: &Arc<Device>,
        name: &str,
        format: vk::Format,
        size: [u32; 2],
        also: ImageUse,
    ) -> Result<Self> {
        let written = if also == ImageUse::FilteredOutput {
            vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::COLOR_ATTACHMENT
        } else if matches!(also, ImageUse::Stored | ImageUse::StoredOutput) {
            vk::ImageUsageFlags::STORAGE
        } else if is_depth(format) {
            vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
        } else {
            vk::ImageUsageFlags::COLOR_ATTACHMENT
        };
        let other = match also {
            ImageUse::Sampled => vk::ImageUsageFlags::SAMPLED,
            ImageUse::Transient => {
                vk::ImageUsageFlags::TRANSIENT_ATTACHMENT | vk::ImageUsageFlags::INPUT_ATTACHMENT
            }
            #[cfg(feature = "window")]
            ImageUse::Window => vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST,
            ImageUse::Output | ImageUse::FilteredOutput => {
                vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::SAMPLED
            }
            ImageUse::Stored | ImageUse::StoredOutput => {
                vk::ImageUsageFlags::TRANSFER_SRC
                    | vk::ImageUsageFlags::TRANSFER_DST
                    | vk::ImageUsageFlags::SAMPLED
            }
        };
        let info = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(format)
            .extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(written | other);
        // SAFETY: `info` is valid; the image is destroyed in `drop`.
        let raw = unsafe { device.raw.create_image(&info, None) }.map_err(Error::vulkan("vkCreateImage"))?;
        let mut image =
            Self { raw, view: vk::ImageView::null(), format, size, allocation: None, device: device.clone() };
        let location = if also == ImageUse::Transient { Location::Transient } else { Location::Device };
        image.bind(name, location)?;
        image.make_view()?;
        device.name(image.raw, name);
        device.name(image.view, name);
        Ok(image)
    }

    fn bind(&mut self, name: &str, location: Location) -> Result<()> {
        let device = &self.device;
        // SAFETY: the image is the device's.
        let requirements = unsafe { device.raw.get_image_memory_requirements(self.raw) };
        let request = MemoryRequest { name, requirements, location, linear: false };
        let (memory, offset) =
            self.allocation.insert(memory::allocate(device, &request)?).memory_and_offset();
        // SAFETY: the memory was allocated for this image's requirements and is bound once.
        unsafe { device.raw.bind_image_memory(self.raw, memory, offset) }
            .map_err(Error::vulkan("vkBindImageMemory"))
    }

    fn make_view(&mut self) -> Result<()> {
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(self.format)
            .subresource_range(self.range());
        // SAFETY: the image is alive and bound; the view is destroyed in `drop`.
        self.view = unsafe { self.device.raw.create_image_view(&info, None) }
            .map_err(Error::vulkan("vkCreateImageView"))?;
        Ok(())
    }

    pub(super) fn aspect(&self) -> vk::ImageAspectFlags {
        match self.format {
            vk::Format::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
            vk::Format::D32_SFLOAT_S8_UINT => vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL,
            _ => vk::ImageAspectFlags::COLOR,
        }
    }

    pub(super) fn range(&self) -> vk::ImageSubresourceRange {
        whole(self.aspect())
    }

    /// A view of the whole image, for attachments.
    pub fn view(&self) -> vk::ImageView {
        self.view
    }

    /// Width and height, px.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Its format.
    pub fn format(&self) -> vk::Format {
        self.format
    }

    /// Size of a pixel in a buffer copy, bytes.
    pub fn pixel_bytes(&self) -> u64 {
        pixel_bytes(self.format)
    }

    /// Memory of the image, bytes.
    pub fn bytes(&self) -> u64 {
        self.allocation.as_ref().map_or(0, Allocation::size)
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        self.device.history.forget_image(self.raw);
        // SAFETY: the GPU is done with it (see the module's docs); a null view is ignored.
        unsafe {
            self.device.raw.destroy_image_view(self.view, None);
            self.device.raw.destroy_image(self.raw, None);
        }
        if let Some(allocation) = self.allocation.take() {
            memory::free(&self.device, allocation);
        }
    }
}

/// The range of all of an image with one level and one layer.
pub(super) fn whole(aspect_mask: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange {
        aspect_mask,
        base_mip_level: 0,
        level_count: 1,
        base_array_layer: 0,
        layer_count: 1,
    }
}

pub(super) fn is_depth(format: vk::Format) -> bool {
    matches!(format, vk::Format::D32_SFLOAT | vk::Format::D32_SFLOAT_S8_UINT)
}
