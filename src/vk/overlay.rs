//! The overlay pass: draws panels and other widgets over a window's image.

use super::Device;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// Layout of the window's image before and after the pass.
const LAYOUT: vk::ImageLayout = vk::ImageLayout::TRANSFER_DST_OPTIMAL;

/// A render pass that loads and keeps the window's image.
pub(super) struct Overlay {
    pub(super) raw: vk::RenderPass,
    device: Arc<Device>,
}

impl Overlay {
    pub(super) fn new(device: &Arc<Device>, format: vk::Format) -> Result<Self> {
        let attachments = [vk::AttachmentDescription::default()
            .format(format)
            .samples(vk::SampleCountFlags::TYPE_1)
            .load_op(vk::AttachmentLoadOp::LOAD)
            .store_op(vk::AttachmentStoreOp::STORE)
            .initial_layout(LAYOUT)
            .final_layout(LAYOUT)];
        let colour =
            vk::AttachmentReference { attachment: 0, layout: vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL };
        let colours = [colour];
        let subpasses = [vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colours)];
        let copies = (vk::PipelineStageFlags::TRANSFER, vk::AccessFlags::TRANSFER_WRITE);
        let draws = (
            vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT,
            vk::AccessFlags::COLOR_ATTACHMENT_READ | vk::AccessFlags::COLOR_ATTACHMENT_WRITE,
        );
        let between = |[from, to]: [u32; 2], (source, done), (target, next)| vk::SubpassDependency {
            src_subpass: from,
            dst_subpass: to,
            src_stage_mask: source,
            src_access_mask: done,
            dst_stage_mask: target,
            dst_access_mask: next,
            dependency_flags: vk::DependencyFlags::empty(),
        };
        let outside = vk::SUBPASS_EXTERNAL;
        let dependencies = [between([outside, 0], copies, draws), between([0, outside], draws, copies)];
        let info = vk::RenderPassCreateInfo::default()
            .attachments(&attachments)
            .subpasses(&subpasses)
            .dependencies(&dependencies);
        // SAFETY: `info` is valid; the pass is destroyed in `drop`.
        let raw = unsafe { device.raw.create_render_pass(&info, None) };
        Ok(Self { raw: raw.map_err(Error::vulkan("vkCreateRenderPass"))?, device: device.clone() })
    }

    /// A framebuffer for a window's image. The caller destroys it.
    pub(super) fn framebuffer(
        &self,
        view: vk::ImageView,
        [width, height]: [u32; 2],
    ) -> Result<vk::Framebuffer> {
        let views = [view];
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(self.raw)
            .attachments(&views)
            .width(width)
            .height(height)
            .layers(1);
        // SAFETY: the view is alive and of the pass's format.
        unsafe { self.device.raw.create_framebuffer(&info, None) }
            .map_err(Error::vulkan("vkCreateFramebuffer"))
    }
}

impl Drop for Overlay {
    fn drop(&mut self) {
        // SAFETY: the presenter has waited for the device.
        unsafe { self.device.raw.destroy_render_pass(self.raw, None) };
    }
}
