//! A pass after that of [`Native`]: eye-dome lighting and ambient occlusion by the depth that it leaves.

use super::frame::Way;
use super::image::Target;
use super::native::Native;
use super::{Host, Result};
use ash::vk;
use std::sync::Arc;
use surfel::Settings;
use surfel::embed::{self, DepthAttachment, DepthShading, Pass, View};
use surfel::vk::Device;
use vk::{AccessFlags as Access, ImageLayout as Layout, PipelineStageFlags as Stages};

/// The pass: it loads the colours of a [`Native`], a transfer source before and after.
pub struct Darkening {
    // Destroyed before its pass.
    pub shading: DepthShading,
    pass: Option<vk::RenderPass>,
    /// Framebuffer of a render pass.
    framebuffer: Option<vk::Framebuffer>,
}

impl Darkening {
    /// The target of the draw, in `pass` or by dynamic rendering.
    pub fn target(colour: vk::Format, pass: Option<vk::RenderPass>) -> embed::Target {
        embed::Target {
            pass: pass.map_or(Pass::Rendering, |pass| Pass::Subpass { pass, subpass: 0 }),
            colours: vec![colour],
            depth: None,
            stencil: vk::Format::UNDEFINED,
            reversed: false,
            write_depth: false,
            samples: vk::SampleCountFlags::TYPE_1,
            picture: 0,
            normal: None,
            id: None,
            encode: false,
        }
    }

    /// Creates the pass for pictures of `native`.
    pub fn new(host: &Host, device: &Arc<Device>, native: &Native, way: Way) -> Result<Self> {
        let colour = native.kind.colour;
        let pass = (way == Way::Subpass).then(|| render_pass(host, colour)).transpose()?;
        // SAFETY: the pass outlives the shading.
        let shading = unsafe { DepthShading::new(device, &Self::target(colour, pass), 2)? };
        let mut made = Self { shading, pass, framebuffer: None };
        made.resize(host, native)?;
        Ok(made)
    }

    /// Takes the current attachments of `native`; no frame is in flight.
    pub fn resize(&mut self, host: &Host, native: &Native) -> Result<()> {
        let (depth, view) = native.depth().ok_or("there is no depth")?;
        let depth = DepthAttachment {
            view,
            format: depth.format,
            size: depth.size,
            samples: native.kind.samples,
            layout: Layout::DEPTH_STENCIL_READ_ONLY_OPTIMAL,
        };
        // SAFETY: it is the depth of the next frames.
        unsafe { self.shading.set_depth(&depth)? };
        let Some(pass) = self.pass else { return Ok(()) };
        let [width, height] = depth.size;
        let views = [native.picture_target().view];
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(pass)
            .attachments(&views)
            .width(width)
            .height(height)
            .layers(1);
        // SAFETY: plain Vulkan; the old one is not in use.
        unsafe {
            let old = self.framebuffer.replace(host.device.create_framebuffer(&info, None)?);
            old.into_iter().for_each(|old| host.device.destroy_framebuffer(old, None));
        }
        Ok(())
    }

    /// Records the passes and the draw, after the render pass of `native`.
    pub fn record(
        &mut self,
        host: &Host,
        cmd: vk::CommandBuffer,
        native: &Native,
        (view, settings): (&View, &Settings),
    ) -> Result<()> {
        let (depth, _) = native.depth().ok_or("there is no depth")?;
        let (source, read) = (Layout::TRANSFER_SRC_OPTIMAL, Layout::DEPTH_STENCIL_READ_ONLY_OPTIMAL);
        // The end of the native pass waits for its writes before transfers.
        let (drawn, computed) =
            ((Stages::TRANSFER, Access::empty()), (Stages::COMPUTE_SHADER, Access::SHADER_READ));
        depth.barrier(host, cmd, [(drawn, source), (computed, read)]);
        // SAFETY: outside a render pass, with the depth as `resize` and this say; frames are submitted in order, with two in flight.
        unsafe { self.shading.prepare(cmd, view, settings)? };
        self.begin(host, cmd, native.picture_target());
        // SAFETY: inside the pass of the target.
        let made = unsafe { self.shading.draw(cmd) };
        self.end(host, cmd, native.picture_target());
        let (computed, copied) =
            ((Stages::COMPUTE_SHADER, Access::empty()), (Stages::TRANSFER, Access::TRANSFER_READ));
        depth.barrier(host, cmd, [(computed, read), (copied, source)]);
        Ok(made?)
    }

    fn begin(&self, host: &Host, cmd: vk::CommandBuffer, colour: &Target) {
        let [width, height] = colour.size;
        let area = vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() };
        // SAFETY: recorded outside a render pass; `end` ends it.
        unsafe {
            if let Some((pass, framebuffer)) = self.pass.zip(self.framebuffer) {
                let info = vk::RenderPassBeginInfo::default()
                    .render_pass(pass)
                    .framebuffer(framebuffer)
                    .render_area(area);
                host.device.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE);
                return;
            }
            colour.transition(host, cmd, [Layout::TRANSFER_SRC_OPTIMAL, Layout::COLOR_ATTACHMENT_OPTIMAL]);
            let colours = [vk::RenderingAttachmentInfo::default()
                .image_view(colour.view)
                .image_layout(Layout::COLOR_ATTACHMENT_OPTIMAL)
                .load_op(vk::AttachmentLoadOp::LOAD)
                .store_op(vk::AttachmentStoreOp::STORE)];
            let info =
                vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&colours);
            host.rendering.cmd_begin_rendering(cmd, &info);
        }
    }

    fn end(&self, host: &Host, cmd: vk::CommandBuffer, colour: &Target) {
        // SAFETY: `begin` began it.
        unsafe {
            if self.pass.is_some() {
                host.device.cmd_end_render_pass(cmd);
                return;
            }
            host.rendering.cmd_end_rendering(cmd);
        }
        colour.transition(host, cmd, [Layout::COLOR_ATTACHMENT_OPTIMAL, Layout::TRANSFER_SRC_OPTIMAL]);
    }

    /// Destroys it, once the GPU has finished using it.
    pub fn destroy(self, host: &Host) {
        drop(self.shading);
        // SAFETY: by the caller.
        unsafe {
            self.framebuffer.into_iter().for_each(|old| host.device.destroy_framebuffer(old, None));
            self.pass.into_iter().for_each(|pass| host.device.destroy_render_pass(pass, None));
        }
    }
}

/// A render pass that loads the colour, a transfer source before and after.
fn render_pass(host: &Host, format: vk::Format) -> Result<vk::RenderPass> {
    let attachment = vk::AttachmentDescription::default()
        .format(format)
        .samples(vk::SampleCountFlags::TYPE_1)
        .load_op(vk::AttachmentLoadOp::LOAD)
        .store_op(vk::AttachmentStoreOp::STORE)
        .initial_layout(Layout::TRANSFER_SRC_OPTIMAL)
        .final_layout(Layout::TRANSFER_SRC_OPTIMAL);
    let colour = [vk::AttachmentReference { attachment: 0, layout: Layout::COLOR_ATTACHMENT_OPTIMAL }];
    let subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colour);
    let drawn = Access::COLOR_ATTACHMENT_READ | Access::COLOR_ATTACHMENT_WRITE;
    let begin = vk::SubpassDependency::default()
        .src_subpass(vk::SUBPASS_EXTERNAL)
        .src_stage_mask(Stages::TRANSFER)
        .dst_stage_mask(Stages::COLOR_ATTACHMENT_OUTPUT)
        .dst_access_mask(drawn);
    let end = vk::SubpassDependency::default()
        .dst_subpass(vk::SUBPASS_EXTERNAL)
        .src_stage_mask(Stages::COLOR_ATTACHMENT_OUTPUT)
        .src_access_mask(Access::COLOR_ATTACHMENT_WRITE)
        .dst_stage_mask(Stages::TRANSFER)
        .dst_access_mask(Access::TRANSFER_READ);
    let (attachments, subpasses, dependencies) = ([attachment], [subpass], [begin, end]);
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses)
        .dependencies(&dependencies);
    // SAFETY: plain Vulkan.
    Ok(unsafe { host.device.create_render_pass(&info, None)? })
}
