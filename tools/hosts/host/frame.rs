//! What the host draws into: colour and depth, in a subpass of a render pass or by dynamic rendering, resolved where it is multisampled.

use super::image::Target;
use super::{Host, Result};
use ash::vk;
use surfel::embed;

/// How the host draws.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// In a render pass of one subpass.
    Subpass,
    /// By dynamic rendering.
    Rendering,
}

/// What a frame is drawn with.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    pub way: Way,
    pub colour: vk::Format,
    /// A second target, the first in order, for normals.
    pub normals: bool,
    pub samples: vk::SampleCountFlags,
    /// Greater is nearer.
    pub reversed: bool,
}

impl Kind {
    /// Formats of the colour targets.
    fn formats(&self) -> Vec<vk::Format> {
        self.normals.then_some(NORMALS).into_iter().chain([self.colour]).collect()
    }
}

/// Colour and depth of a frame.
pub struct Frame {
    pub kind: Kind,
    pub size: [u32; 2],
    normals: Option<Target>,
    colour: Target,
    depth: Target,
    resolved: Option<Target>,
    pass: Option<(vk::RenderPass, vk::Framebuffer)>,
}

/// The host's format of depth.
pub const DEPTH: vk::Format = vk::Format::D32_SFLOAT;
const NORMALS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
/// Where the picture is copied from.
const SOURCE: vk::ImageLayout = vk::ImageLayout::TRANSFER_SRC_OPTIMAL;

impl Frame {
    /// A frame of `size` px.
    pub fn new(host: &Host, kind: Kind, size: [u32; 2]) -> Result<Self> {
        use vk::ImageUsageFlags as Usage;
        let one = vk::SampleCountFlags::TYPE_1;
        let drawn = Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC;
        let tested = Usage::DEPTH_STENCIL_ATTACHMENT | Usage::TRANSFER_SRC;
        let colour = Target::new(host, kind.colour, size, kind.samples, drawn)?;
        let depth = Target::new(host, DEPTH, size, kind.samples, tested)?;
        let resolved =
            (kind.samples != one).then(|| Target::new(host, kind.colour, size, one, drawn)).transpose()?;
        let normals =
            kind.normals.then(|| Target::new(host, NORMALS, size, kind.samples, drawn)).transpose()?;
        let views: Vec<_> = [normals.as_ref(), Some(&colour), Some(&depth), resolved.as_ref()]
            .into_iter()
            .flatten()
            .map(|t| t.view)
            .collect();
        // SAFETY: a plain use of Vulkan; `destroy` destroys what is made.
        let make = || unsafe {
            let pass = render_pass(host, kind)?;
            let info = vk::FramebufferCreateInfo::default()
                .render_pass(pass)
                .attachments(&views)
                .width(size[0])
                .height(size[1])
                .layers(1);
            Ok::<_, vk::Result>((pass, host.device.create_framebuffer(&info, None)?))
        };
        let pass = (kind.way == Way::Subpass).then(make).transpose()?;
        Ok(Self { kind, size, normals, colour, depth, resolved, pass })
    }

    /// What surfels are told of it.
    pub fn target(&self) -> embed::Target {
        embed::Target {
            pass: match self.pass {
                Some((pass, _)) => embed::Pass::Subpass { pass, subpass: 0 },
                None => embed::Pass::Rendering,
            },
            colours: self.kind.formats(),
            depth: Some(DEPTH),
            stencil: vk::Format::UNDEFINED,
            reversed: self.kind.reversed,
            samples: self.kind.samples,
            picture: u32::from(self.kind.normals),
            normal: self.kind.normals.then_some(0),
            encode: false,
        }
    }

    /// What the host's own pipelines are told of it, where there are no normals.
    pub fn place(&self) -> super::mesh::Where<'_> {
        let formats = (std::slice::from_ref(&self.kind.colour), DEPTH);
        super::mesh::Where {
            pass: self.pass.map_or(vk::RenderPass::null(), |(pass, _)| pass),
            subpass: 0,
            formats: self.pass.is_none().then_some(formats),
            samples: self.kind.samples,
            colours: 1,
            reversed: self.kind.reversed,
        }
    }

    /// Begins the pass: colour is 0, depth the farthest.
    pub fn begin(&self, host: &Host, cmd: vk::CommandBuffer) {
        let far = if self.kind.reversed { 0.0 } else { 1.0 };
        let black = vk::ClearValue::default();
        let farthest =
            vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth: far, stencil: 0 } };
        let normals = self.kind.normals.then_some(black);
        let clears: Vec<_> = normals.into_iter().chain([black, farthest]).collect();
        let [width, height] = self.size;
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        if let Some((pass, framebuffer)) = self.pass {
            let info = vk::RenderPassBeginInfo::default()
                .render_pass(pass)
                .framebuffer(framebuffer)
                .render_area(area)
                .clear_values(&clears);
            // SAFETY: recorded outside a render pass; `end` ends it.
            unsafe { host.device.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE) };
            return;
        }
        let (drawn, tested) =
            (vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL);
        for target in
            [self.normals.as_ref(), Some(&self.colour), self.resolved.as_ref()].into_iter().flatten()
        {
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
        let normals = self.normals.as_ref().map(|normals| attachment(normals, drawn, black));
        let colours: Vec<_> = normals.into_iter().chain([colour]).collect();
        let depth = attachment(&self.depth, tested, farthest);
        let info = vk::RenderingInfo::default()
            .render_area(area)
            .layer_count(1)
            .color_attachments(&colours)
            .depth_attachment(&depth);
        // SAFETY: as above.
        unsafe { host.rendering.cmd_begin_rendering(cmd, &info) };
    }

    /// Ends the pass and leaves the colour, and the depth of one sample, ready to be copied.
    pub fn end(&self, host: &Host, cmd: vk::CommandBuffer) {
        // SAFETY: `begin` began it.
        unsafe {
            match self.pass {
                Some(_) => host.device.cmd_end_render_pass(cmd),
                None => host.rendering.cmd_end_rendering(cmd),
            }
        }
        if self.pass.is_none() {
            self.picture().transition(host, cmd, [vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, SOURCE]);
            self.depth.transition(host, cmd, [vk::ImageLayout::DEPTH_ATTACHMENT_OPTIMAL, SOURCE]);
            if let Some(normals) = &self.normals {
                normals.transition(host, cmd, [vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, SOURCE]);
            }
        }
    }

    fn picture(&self) -> &Target {
        self.resolved.as_ref().unwrap_or(&self.colour)
    }

    /// The colours, of RGBA floats, and the depths, where there is one sample.
    pub fn read(&self, host: &Host) -> Result<(Vec<[f32; 4]>, Vec<f32>)> {
        let colours = self.copy(host, self.picture(), 16)?;
        let depths = if self.resolved.is_none() { self.copy(host, &self.depth, 4)? } else { Vec::new() };
        Ok((bytemuck::pod_collect_to_vec(&colours), bytemuck::pod_collect_to_vec(&depths)))
    }

    /// The normals, where there are any.
    pub fn read_normals(&self, host: &Host) -> Result<Vec<[f32; 4]>> {
        let bytes = self.normals.as_ref().map(|normals| self.copy(host, normals, 16)).transpose()?;
        Ok(bytemuck::pod_collect_to_vec(&bytes.unwrap_or_default()))
    }

    /// The bytes of the colours, `bytes` a pixel.
    pub fn read_bytes(&self, host: &Host, bytes: usize) -> Result<Vec<u8>> {
        self.copy(host, self.picture(), bytes)
    }

    fn copy(&self, host: &Host, target: &Target, bytes: usize) -> Result<Vec<u8>> {
        let size = bytes * self.size[0] as usize * self.size[1] as usize;
        let (buffer, memory) = host.buffer(&vec![0; size], vk::BufferUsageFlags::TRANSFER_DST)?;
        host.run(|cmd| {
            target.transition(host, cmd, [SOURCE, SOURCE]);
            target.copy_to(host, cmd, buffer);
            host_reads(host, cmd);
            Ok(())
        })?;
        let found = host.read(memory, size);
        // SAFETY: the copy was waited for.
        unsafe {
            host.device.destroy_buffer(buffer, None);
            host.device.free_memory(memory, None);
        }
        found
    }

    /// The image of the picture, which `end` leaves ready to be copied.
    pub fn image(&self) -> vk::Image {
        self.picture().image
    }

    /// Has `size` px from now on, and the same pass. The GPU is done with the frames before.
    pub fn resize(&mut self, host: &Host, size: [u32; 2]) -> Result<()> {
        let mut made = Self::new(host, self.kind, size)?;
        // A framebuffer goes with every pass like its own.
        if let (Some((new, _)), Some((old, _))) = (&mut made.pass, &mut self.pass) {
            std::mem::swap(new, old);
        }
        std::mem::replace(self, made).destroy(host);
        Ok(())
    }

    /// Destroys it, once the GPU is done with it.
    pub fn destroy(self, host: &Host) {
        // SAFETY: by the caller.
        unsafe {
            if let Some((pass, framebuffer)) = self.pass {
                host.device.destroy_framebuffer(framebuffer, None);
                host.device.destroy_render_pass(pass, None);
            }
        }
        [self.normals, Some(self.colour), Some(self.depth), self.resolved]
            .into_iter()
            .flatten()
            .for_each(|t| t.destroy(host));
    }
}

fn host_reads(host: &Host, cmd: vk::CommandBuffer) {
    let barrier = vk::MemoryBarrier::default()
        .src_access_mask(vk::AccessFlags::TRANSFER_WRITE)
        .dst_access_mask(vk::AccessFlags::HOST_READ);
    let [from, to] = [vk::PipelineStageFlags::TRANSFER, vk::PipelineStageFlags::HOST];
    // SAFETY: recorded outside a render pass.
    unsafe {
        host.device.cmd_pipeline_barrier(cmd, from, to, vk::DependencyFlags::empty(), &[barrier], &[], &[])
    };
}

unsafe fn render_pass(host: &Host, kind: Kind) -> std::result::Result<vk::RenderPass, vk::Result> {
    let attachment = |format, samples, load| {
        vk::AttachmentDescription::default()
            .format(format)
            .samples(samples)
            .load_op(load)
            .store_op(vk::AttachmentStoreOp::STORE)
            .initial_layout(vk::ImageLayout::UNDEFINED)
            .final_layout(SOURCE)
    };
    let drawn = kind.formats().into_iter().chain([DEPTH]);
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
    // Frames take turns with the same targets.
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
    // SAFETY: a plain use of Vulkan.
    unsafe { host.device.create_render_pass(&info, None) }
}
