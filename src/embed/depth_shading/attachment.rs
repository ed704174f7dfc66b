//! Description of the host's depth attachment.

use crate::embed::attachments::{self, Purpose};
use crate::error::{Cause, Error, Result};
use crate::frame::targets::check_size;
use crate::vk::Device;
use ash::vk;

/// Layouts in which shaders can read depth on every device.
const LAYOUTS: [vk::ImageLayout; 4] = [
    vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
    vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    vk::ImageLayout::DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL,
    vk::ImageLayout::GENERAL,
];

/// The host's depth attachment, whose image has the usage `SAMPLED`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthAttachment {
    /// A two-dimensional view of the depth aspect only.
    pub view: vk::ImageView,
    /// Its format.
    pub format: vk::Format,
    /// Width and height, px.
    pub size: [u32; 2],
    /// Sample count. The nearest sample of a pixel is its surface.
    pub samples: vk::SampleCountFlags,
    /// Layout of the image when the passes read it: `DEPTH_STENCIL_READ_ONLY_OPTIMAL`, `SHADER_READ_ONLY_OPTIMAL`,
    /// `DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL` or `GENERAL`.
    pub layout: vk::ImageLayout,
}

impl DepthAttachment {
    /// Validates the attachment for `device`.
    pub(super) fn check(&self, device: &Device) -> Result<()> {
        let refuse = |cause: Cause| Err(Error::Usage(format!("the host's depth is not supported: {cause}")));
        if self.view == vk::ImageView::null() {
            return refuse("there is no view: create one of the depth aspect".into());
        }
        if !LAYOUTS.contains(&self.layout) {
            let layouts = LAYOUTS.map(|layout| format!("{layout:?}")).join(", ");
            return refuse(
                format!("its layout is {:?}, which shaders cannot read: give one of {layouts}", self.layout)
                    .into(),
            );
        }
        attachments::check(device, "depth", Purpose::SampledDepth, self.format, self.samples)
            .or_else(refuse)?;
        check_size(device, self.size)
    }
}
