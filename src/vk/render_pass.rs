//! Render passes of one subpass, and framebuffers.

use super::pipeline_pool::PassKey;
use super::{Device, Image, image::is_depth};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// A target of a render pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Attachment {
    /// No attachment at this location; output to it is discarded.
    Absent,
    /// Cleared to 0 and stored.
    Cleared(vk::Format),
    /// Not loaded: every pixel is written.
    Overwritten(vk::Format),
    /// A depth target that is tested but not written.
    Tested(vk::Format),
}

/// A render pass. Attachments keep the layout of their use: the recorder performs all transitions.
pub struct RenderPass {
    pub(super) raw: vk::RenderPass,
    /// Formats of colours and depth.
    formats: (Vec<Option<vk::Format>>, Option<vk::Format>),
    attachments: usize,
    device: Arc<Device>,
}

impl RenderPass {
    /// A pass with `colours` at locations 0, 1, …, and `depth` if given.
    pub fn new(device: &Arc<Device>, colours: &[Attachment], depth: Option<Attachment>) -> Result<Self> {
        let mut descriptions = Vec::new();
        let mut reference = |attachment: &Attachment| match attachment.describe() {
            None => vk::AttachmentReference {
                attachment: vk::ATTACHMENT_UNUSED,
                layout: vk::ImageLayout::UNDEFINED,
            },
            Some(description) => {
                descriptions.push(description);
                let attachment = descriptions.len() as u32 - 1;
                vk::AttachmentReference { attachment, layout: description.initial_layout }
            }
        };
        let colour_references: Vec<_> = colours.iter().map(&mut reference).collect();
        let depth_reference = depth.as_ref().map(&mut reference);
        let mut subpass = vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colour_references);
        if let Some(depth) = &depth_reference {
            subpass = subpass.depth_stencil_attachment(depth);
        }
        let subpasses = [subpass];
        let info = vk::RenderPassCreateInfo::default().attachments(&descriptions).subpasses(&subpasses);
        // SAFETY: every reference is to an attachment of the list; the pass is destroyed in `drop`.
        let raw = unsafe { device.raw.create_render_pass(&info, None) }
            .map_err(Error::vulkan("vkCreateRenderPass"))?;
        Ok(Self {
            raw,
            formats: (
                colours.iter().map(Attachment::format).collect(),
                depth.as_ref().and_then(Attachment::format),
            ),
            attachments: descriptions.len(),
            device: device.clone(),
        })
    }
}

impl RenderPass {
    pub(super) fn colour_targets(&self) -> usize {
        self.formats.0.len()
    }

    pub(super) fn key(&self) -> PassKey {
        PassKey::Formats(self.formats.0.clone(), self.formats.1)
    }

    /// The Vulkan handle.
    pub fn handle(&self) -> vk::RenderPass {
        self.raw
    }
}

impl Attachment {
    fn format(&self) -> Option<vk::Format> {
        self.describe().map(|description| description.format)
    }

    fn describe(&self) -> Option<vk::AttachmentDescription> {
        let (format, load) = match *self {
            Self::Absent => return None,
            Self::Cleared(format) => (format, vk::AttachmentLoadOp::CLEAR),
            Self::Overwritten(format) => (format, vk::AttachmentLoadOp::DONT_CARE),
            Self::Tested(format) => (format, vk::AttachmentLoadOp::LOAD),
        };
        let layout = match (is_depth(format), self) {
            (false, _) => vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL,
            (true, Self::Tested(_)) => vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
            (true, _) => vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
        };
        Some(
            vk::AttachmentDescription::default()
                .format(format)
                .samples(vk::SampleCountFlags::TYPE_1)
                .load_op(load)
                .store_op(vk::AttachmentStoreOp::STORE)
                .stencil_load_op(vk::AttachmentLoadOp::DONT_CARE)
                .stencil_store_op(vk::AttachmentStoreOp::DONT_CARE)
                .initial_layout(layout)
                .final_layout(layout),
        )
    }
}

impl Drop for RenderPass {
    fn drop(&mut self) {
        // SAFETY: the GPU is done with it (see the module's docs).
        unsafe { self.device.raw.destroy_render_pass(self.raw, None) };
    }
}

/// The images that a render pass draws into.
pub struct Framebuffer {
    pub(super) raw: vk::Framebuffer,
    pub(super) render_pass: vk::RenderPass,
    pub(super) extent: vk::Extent2D,
    pub(super) attachments: usize,
    device: Arc<Device>,
}

impl Framebuffer {
    /// One image per attachment that is not absent: colours in order, then depth. All have one size.
    pub fn new(device: &Arc<Device>, pass: &RenderPass, images: &[&Image]) -> Result<Self> {
        assert_eq!(images.len(), pass.attachments, "one image an attachment");
        let sizes = images.windows(2).all(|pair| pair[0].size() == pair[1].size());
        assert!(sizes, "images of one size");
        let views: Vec<_> = images.iter().map(|image| image.view).collect();
        let [width, height] = images.first().map_or([1, 1], |image| image.size());
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(pass.raw)
            .attachments(&views)
            .width(width)
            .height(height)
            .layers(1);
        // SAFETY: the views are alive and of the pass's formats; the framebuffer is destroyed in `drop`.
        let raw = unsafe { device.raw.create_framebuffer(&info, None) }
            .map_err(Error::vulkan("vkCreateFramebuffer"))?;
        Ok(Self {
            raw,
            render_pass: pass.raw,
            extent: vk::Extent2D { width, height },
            attachments: pass.attachments,
            device: device.clone(),
        })
    }
}

impl Drop for Framebuffer {
    fn drop(&mut self) {
        // SAFETY: the GPU is done with it (see the module's docs).
        unsafe { self.device.raw.destroy_framebuffer(self.raw, None) };
    }
}
