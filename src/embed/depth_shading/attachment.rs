//! Description of the host's depth attachment.

use crate::embed::attachments::{self, Purpose};
use crate::error::{Cause, Error, Result};
use crate::frame::targets::check_size;
use crate::vk::Device;
use ash::vk;

/// Layouts in which shaders can read depth: the first four on every device, the others with a feature that the host has enabled.
const LAYOUTS: [vk::ImageLayout; 6] = [
    vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
    vk::ImageLayout::SHADER_READ_ONLY_OPTIMAL,
    vk::ImageLayout::DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL,
    vk::ImageLayout::GENERAL,
    vk::ImageLayout::DEPTH_READ_ONLY_OPTIMAL,
    vk::ImageLayout::READ_ONLY_OPTIMAL,
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
    /// `DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL` or `GENERAL`; or, if the host has enabled separateDepthStencilLayouts,
    /// `DEPTH_READ_ONLY_OPTIMAL`; or, with synchronization2, `READ_ONLY_OPTIMAL`.
    pub layout: vk::ImageLayout,
}

impl DepthAttachment {
    /// Validates the attachment for `device`.
    pub(super) fn check(&self, device: &Device) -> Result<()> {
        let refuse = |cause: Cause| Err(Error::Usage(format!("the host's depth is not supported: {cause}")));
        if self.view == vk::ImageView::null() {
            return refuse("there is no view: create one of the depth aspect".into());
        }
        check_layout(self.layout).or_else(refuse)?;
        attachments::check(device, "depth", Purpose::SampledDepth, self.format, self.samples)
            .or_else(refuse)?;
        check_size(device, self.size)
    }
}

fn check_layout(layout: vk::ImageLayout) -> Result<(), Cause> {
    if LAYOUTS.contains(&layout) {
        return Ok(());
    }
    let layouts = LAYOUTS.map(|layout| format!("{layout:?}")).join(", ");
    Err(format!("its layout is {layout:?}, which shaders cannot read: give one of {layouts}").into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use vk::ImageLayout as Layout;

    #[test]
    fn layouts_that_shaders_read_are_accepted() {
        let read = [
            Layout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
            Layout::DEPTH_READ_ONLY_OPTIMAL,
            Layout::READ_ONLY_OPTIMAL,
        ];
        assert!(read.into_iter().all(|layout| check_layout(layout).is_ok()));
        assert!(check_layout(Layout::DEPTH_ATTACHMENT_OPTIMAL).is_err());
    }
}
