//! The host's frame: colour and depth, in a subpass of a render pass or by dynamic rendering, resolved if multisampled.

use super::image::{Target, has_stencil};
use super::{Host, Result};
use ash::vk;
use surfel::embed;

/// Kind of the host's pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// A render pass with one subpass.
    Subpass,
    /// Dynamic rendering.
    Rendering,
}

/// Configuration of a frame.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    pub way: Way,
    pub colour: vk::Format,
    /// Whether there is a second target, at location 0, for normals.
    pub normals: bool,
    pub samples: vk::SampleCountFlags,
    /// Reversed depth: greater is nearer.
    pub reversed: bool,
}

/// Colour and depth of a frame.
pub struct Frame {
    pub kind: Kind,
    pub size: [u32; 2],
    /// Colour targets before the picture's.
    more: Vec<Target>,
    colour: Target,
    depth: Target,
    resolved: Option<Target>,
    pass: Option<(vk::RenderPass, vk::Framebuffer)>,
}

/// Depth format of the host.
pub const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
const NORMALS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Format of point ids.
pub const IDS: vk::Format = vk::Format::R32_UINT;
/// Layout of the picture before the copy.
const TESTED: vk::ImageLayout = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
const SOURCE: vk::ImageLayout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;

impl Frame {
    /// Creates a frame of `size` px.
    pub fn new(host: &Host, kind: Kind, size: [u32; 2]) -> Result<Self> {
        let normals = [NORMALS];
        Self::with(host, kind, size, if kind.normals { &normals } else { &[] })
    }

    /// A frame with targets of these formats before that of the picture.
    pub fn with(host: &Host, kind: Kind, size: [u32; 2], more: &[vk::Format]) -> Result<Self> {
        Self::with_depth(host, kind, size, more, DEPTH)
    }

    /// Like [`Frame::with`], with another depth format.
    pub fn with_depth(
        host: &Host,
        kind: Kind,
        size: [u32; 2],
        more: &[vk::Format],
        depth: vk::Format,
    ) -> Result<Self> {
        use vk::ImageUsageFlags as Usage;
        let one = vk::SampleCountFlags::TYPE_1;
        let drawn = Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC;
        let tested = Usage::DEPTH_STENCIL_ATTACHMENT | Usage::TRANSFER_SRC;
        let colour = Target::new(host, kind.colour, size, kind.samples, drawn)?;
        let depth = Target::new(host, depth, size, kind.samples, tested)?;
        let resolved =
            (kind.samples != one).then(|| Target::new(host, kind.colour, size, one, drawn)).transpose()?;
        let formats: Vec<_> = more.iter().copied().chain([kind.colour]).collect();
        let more = more
            .iter()
            .map(|format| Target::new(host, *format, size, kind.samples, drawn))
            .collect::<Result<Vec<_>>>()?;
        let views: Vec<_> =
            more.iter().chain([&colour, &depth]).chain(&resolved).map(|target| target.view).collect();
        // SAFETY: plain Vulkan; `destroy` destroys the objects.
        let make = || unsafe {
            let pass = render_pass(host, kind, &formats, depth.format)?;
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(pass)
                .attachments(&views)
                .width(size[0])
                .height(size[1])
                .layers(1);
            Ok::<_, vk::Result>((pass, host.device.create_framebuffer(&info, None)?))
        };
        let pass = (kind.way == Way::Subpass).then(make).transpose()?;
        Ok(Self { kind, size, more, colour, depth, resolved, pass })
    }

    /// Description of the frame for the engine.
    pub fn target(&self) -> embed::Target {
        embed::Target {
            pass: match self.pass {
                Some((pass, _)) => embed::Pass::Subpass { pass, subpass: 0 },
                None => embed::Pass::Rendering,
            },
            colours: self.more.iter().chain([&self.colour]).map(|target| target.format).collect(),
            depth: Some(self.depth.format),
            stencil: self.stencil(),
            reversed: self.kind.reversed,
            write_depth: true,
            samples: self.kind.samples,
            picture: self.more.len() as u32,
            normal: self.location(NORMALS),
            id: self.location(IDS),
            encode: false,
        }
    }

    /// Format of the stencil, that of a depth format with stencil.
    fn stencil(&self) -> vk::Format {
        if has_stencil(self.depth.format) { self.depth.format } else { vk::Format::UNDEFINED }
    }

    /// The first location before the picture's with this format.
    fn location(&self, format: vk::Format) -> Option<u32> {
        self.more.iter().position(|target| target.format == format).map(|location| location as u32)
    }

    /// Target of the host's pipelines if the picture is the only colour.
    pub fn mesh_target(&self) -> super::mesh::MeshTarget<'_> {
        let formats = (std::slice::from_ref(&self.kind.colour), self.depth.format);
        super::mesh::MeshTarget {
            pass: self.pass.map_or(vk::RenderPass::null(), |(pass, _)| pass),
            subpass: 0,
            formats: self.pass.is_none().then_some(formats),
            samples: self.kind.samples,
            colours: 1,
            reversed: self.kind.reversed,
        }
    }

    /// Begins the pass: colour is 0, depth is farthest.
    pub fn begin(&self, host: &Host, cmd: vk::CommandBuffer) {
        self.begin_with(host, cmd, false);
    }

    /// Like [`Frame::begin`], with or without secondary command buffers.
    pub fn begin_with(&self, host: &Host, cmd: vk::CommandBuffer, secondaries: bool) {
        let far = if self.kind.reversed { 0.0 } else { 1.0 };
        let black = vk::ClearValue::default();
        let farthest =
            vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: far, stencil: 0 } };
        let nobody = vk::ClearColorValue { uint32: [surfel::Picture::NOBODY; 4] };
        let cleared = |target: &Target| match target.format {
            IDS => vk::ClearValue { color: nobody },
            _ => black,
        };
        let clears: Vec<_> = self.more.iter().map(cleared).chain([black, farthest]).collect();
        let [width, height] = self.size;
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        if let Some((pass, framebuffer)) = self.pass {
            let info = vk::RenderPassBeginInfo::default()
                .render_pass(pass)
                .framebuffer(framebuffer)
                .render_area(area)
                .clear_values(&clears);
            let contents = if secondaries {
                vk::SubpassContents::SECONDARY_COMMAND_BUFFERS
            } else {
                vk::SubpassContents::INLINE
            };
            // SAFETY: recorded outside a render pass; `end` ends it.
            unsafe { host.device.cmd_begin_render_pass(cmd, &info, contents) };
            return;
        }
        let (drawn, tested) = (vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, TESTED);
        for target in self.more.iter().chain([&self.colour]).chain(&self.resolved) {
            target.transition(host, cmd, [vk::ImageLayout::UNDEFINED, drawn]);
        }
        self.depth.transition(host, cmd, [vk::ImageLayout::UNDEFINED, tested]);
        let attachment = |target: &Target, layout, clear| {
            vk::RenderingAttachmentInfo::default()
                .image_view(target.view)
                .image_layout(layout)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .clear_value(clear)
        };
        let mut colour = attachment(&self.colour, drawn, black);
        if let Some(resolved) = &self.resolved {
            colour = colour
                .resolve_mode(vk::ResolveModeFlags::AVERAGE)
                .resolve_image_view(resolved.view)
                .resolve_image_layout(drawn);
        }
        let more = self.more.iter().map(|target| attachment(target, drawn, cleared(target)));
        let colours: Vec<_> = more.chain([colour]).collect();
        let depth = attachment(&self.depth, tested, farthest);
        let flags = if secondaries {
            vk::RenderingFlags::CONTENTS_SECONDARY_COMMAND_BUFFERS
        } else {
            vk::RenderingFlags::empty()
        };
        let mut info = vk::RenderingInfo::default()
            .flags(flags)
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colours)
            .depth_attachment(&depth);
        if has_stencil(self.depth.format) {
            info = info.stencil_attachment(&depth);
        }
        // SAFETY: as above.
        unsafe { host.rendering.cmd_begin_rendering(cmd, &info) };
    }

    /// Ends the pass, and leaves the colour and the single-sample depth as transfer sources.
    pub fn end(&self, host: &Host, cmd: vk::CommandBuffer) {
        // SAFETY: `begin` began the pass.
        unsafe {
            match self.pass {
                Some(_) => host.device.cmd_end_render_pass(cmd),
                None => host.rendering.cmd_end_rendering(cmd),
            }
        }
        if self.pass.is_none() {
            self.picture().transition(host, cmd, [vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, SOURCE]);
            self.depth.transition(host, cmd, [TESTED, SOURCE]);
            for target in &self.more {
                target.transition(host, cmd, [vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, SOURCE]);
            }
        }
    }

    fn picture(&self) -> &Target {
        self.resolved.as_ref().unwrap_or(&self.colour)
    }

    /// The colours as RGBA floats, and the single-sample depths.
    pub fn read(&self, host: &Host) -> Result<(Vec<[f32; 4]>, Vec<f32>)> {
        let colours = self.picture().read(host, 16)?;
        let depths = if self.resolved.is_none() { self.depth.read(host, 4)? } else { Vec::new() };
        Ok((bytemuck::pod_collect_to_vec(&colours), bytemuck::pod_collect_to_vec(&depths)))
    }

    /// The normals, if any.
    pub fn read_normals(&self, host: &Host) -> Result<Vec<[f32; 4]>> {
        let bytes = self.read_more(host, NORMALS, 16)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    /// The point ids, if any.
    pub fn read_ids(&self, host: &Host) -> Result<Vec<u32>> {
        let bytes = self.read_more(host, IDS, 4)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }

    /// Contents of the first target before the picture's with this format, `bytes` per pixel; empty if there is none.
    fn read_more(&self, host: &Host, format: vk::Format, bytes: usize) -> Result<Vec<u8>> {
        let target = self.more.iter().find(|target| target.format == format);
        target.map_or(Ok(Vec::new()), |target| target.read(host, bytes))
    }

    /// The colours, `bytes` per pixel.
    pub fn read_bytes(&self, host: &Host, bytes: usize) -> Result<Vec<u8>> {
        self.picture().read(host, bytes)
    }

    /// The image of the picture, a transfer source after `end`.
    pub fn image(&self) -> vk::Image {
        self.picture().image
    }

    /// The single-sample depths, of any format.
    pub fn read_depths(&self, host: &Host) -> Result<Vec<f64>> {
        self.depth.read_depths(host)
    }

    /// A secondary command buffer for draws in the pass; the caller frees it.
    pub fn secondary(
        &self,
        host: &Host,
        draw: impl FnOnce(vk::CommandBuffer) -> Result<()>,
    ) -> Result<vk::CommandBuffer> {
        let colours: Vec<_> = self.more.iter().chain([&self.colour]).map(|target| target.format).collect();
        let mut rendering = vk::CommandBufferInheritanceRenderingInfo::default()
            .color_attachment_formats(&colours)
            .depth_attachment_format(self.depth.format)
            .stencil_attachment_format(self.stencil())
            .rasterization_samples(self.kind.samples);
        let inherited = vk::CommandBufferInheritanceInfo::default();
        let inherited = match self.pass {
            Some((pass, framebuffer)) => inherited.render_pass(pass).framebuffer(framebuffer),
            None => inherited.push_next(&mut rendering),
        };
        host.record_secondary(&inherited, draw)
    }

    /// Changes the size, with the same pass. The GPU has finished the frames before.
    pub fn resize(&mut self, host: &Host, size: [u32; 2]) -> Result<()> {
        let more: Vec<_> = self.more.iter().map(|target| target.format).collect();
        let mut made = Self::with_depth(host, self.kind, size, &more, self.depth.format)?;
        // A framebuffer is compatible with any equal pass.
        if let (Some((new, _)), Some((old, _))) = (&mut made.pass, &mut self.pass) {
            std::mem::swap(new, old);
        }
        std::mem::replace(self, made).destroy(host);
        Ok(())
    }

    /// Destroys the frame, once the GPU has finished using it.
    pub fn destroy(self, host: &Host) {
        // SAFETY: by the caller.
        unsafe {
            if let Some((pass, framebuffer)) = self.pass {
                host.device.destroy_framebuffer(framebuffer, None);
                host.device.destroy_render_pass(pass, None);
            }
        }
        let rest = [Some(self.colour), Some(self.depth), self.resolved];
        self.more.into_iter().chain(rest.into_iter().flatten()).for_each(|target| target.destroy(host));
    }
}

/// Creates the pass of a frame with colour targets of these formats.
unsafe fn render_pass(
    host: &Host,
    kind: Kind,
    colours: &[vk::Format],
    depth: vk::Format,
) -> std::result::Result<vk::RenderPass, vk::Result> {
    let attachment = |format, samples, load| {
        vk::AttachmentDescription::default()
            .format(format)
            .samples(samples)
            .load_op(load)
            .store_op(vk::AttachmentStoreOp::STORE)
            .initial_layout(vk::ImageLayout::UNDEFINED)
            .final_layout(SOURCE)
    };
    let drawn = colours.iter().copied().chain([depth]);
    let mut attachments: Vec<_> =
        drawn.map(|format| attachment(format, kind.samples, vk::AttachmentLoadOp::CLEAR)).collect();
    let reference = |attachment, layout| vk::AttachmentReference { attachment, layout };
    let count = attachments.len() as u32;
    let colours: Vec<_> =
        (0..count - 1).map(|i| reference(i, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)).collect();
    let depth = reference(count - 1, vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
    let mut resolves = vec![reference(vk::ATTACHMENT_UNUSED, vk::ImageLayout::UNDEFINED); colours.len()];
    if let Some(last) = resolves.last_mut() {
        *last = reference(count, vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL);
    }
    let mut subpass = vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colours)
        .depth_stencil_attachment(&depth);
    if kind.samples != vk::SampleCountFlags::TYPE_1 {
        attachments.push(attachment(
            kind.colour,
            vk::SampleCountFlags::TYPE_1,
            vk::AttachmentLoadOp::DONT_CARE,
        ));
        subpass = subpass.resolve_attachments(&resolves);
    }
    let subpasses = [subpass];
    // Consecutive frames use the same targets.
    let all = vk::PipelineStageFlags::ALL_COMMANDS;
    let memory = vk::AccessFlags::MEMORY_READ | vk::AccessFlags::MEMORY_WRITE;
    let dependency =
        |[from, to]: [u32; 2], [before, after]: [vk::PipelineStageFlags; 2]| vk::SubpassDependency {
            src_subpass: from,
            dst_subpass: to,
            src_stage_mask: before,
            dst_stage_mask: after,
            src_access_mask: memory,
            dst_access_mask: memory,
            ..Default::default()
        };
    let drawing = vk::PipelineStageFlags::ALL_GRAPHICS;
    let outside = vk::SUBPASS_EXTERNAL;
    let dependencies = [dependency([outside, 0], [all, drawing]), dependency([0, outside], [drawing, all])];
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpasses)
        .dependencies(&dependencies);
    // SAFETY: plain Vulkan.
    unsafe { host.device.create_render_pass(&info, None) }
}
