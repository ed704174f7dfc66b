//! A render pass of the host with surfels in subpasses: the mesh before, fog after.

use super::fog::Fog;
use super::image::Target;
use super::mesh::{Mesh, MeshTarget};
use super::{Host, Result};
use ash::vk;
use glam::Vec3;
use std::sync::Arc;
use surfel::embed::View;
use surfel::embed::native::{Depth, HostRenderPass, Plan, Renderer};
use surfel::scene::Streams;
use surfel::vk::Device;
use surfel::{Precision, Settings};

/// Configuration of the render pass.
#[derive(Clone, Copy, Debug)]
pub struct Kind {
    pub colour: vk::Format,
    /// Format of the depth, if any.
    pub depth: Option<vk::Format>,
    /// Whether there is a target for normals.
    pub normals: bool,
    pub samples: vk::SampleCountFlags,
    /// Reversed depth: greater is nearer.
    pub reversed: bool,
    pub seed: bool,
    /// Whether there is a subpass before, for the mesh, and one after, for fog.
    pub around: [bool; 2],
}

/// A render pass and its contents.
pub struct Native {
    // Surfels are destroyed before their targets.
    pub renderer: Renderer,
    pub kind: Kind,
    pass: vk::RenderPass,
    fog: Option<Fog>,
    framed: Framed,
    clears: Vec<vk::ClearValue>,
}

/// Resources of one size.
struct Framed {
    size: [u32; 2],
    targets: Vec<Target>,
    depth_view: Option<vk::ImageView>,
    framebuffer: vk::Framebuffer,
}

const NORMALS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const ONE: vk::SampleCountFlags = vk::SampleCountFlags::TYPE_1;
const DRAWN: vk::ImageLayout = vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL;
const TESTED: vk::ImageLayout = vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL;
const SEEN: vk::ImageLayout = vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL;

/// Indices of the host's attachments: the colour is 0.
#[derive(Clone, Copy)]
struct AttachmentIndices {
    depth: Option<u32>,
    normals: Option<u32>,
    resolved: Option<u32>,
}

impl Kind {
    fn attachment_indices(&self) -> AttachmentIndices {
        let mut next = 0;
        let mut number = |there: bool| there.then(|| (next += 1, next).1);
        AttachmentIndices {
            depth: number(self.depth.is_some()),
            normals: number(self.normals),
            resolved: number(self.samples != ONE),
        }
    }

    /// Formats and sample counts of the attachments.
    fn formats(&self) -> Vec<(vk::Format, vk::SampleCountFlags)> {
        let depth = self.depth.map(|depth| (depth, self.samples));
        let normals = self.normals.then_some((NORMALS, self.samples));
        let resolved = (self.samples != ONE).then_some((self.colour, ONE));
        [Some((self.colour, self.samples)), depth, normals, resolved].into_iter().flatten().collect()
    }

    /// The attachments: cleared at the start, transfer sources at the end.
    pub fn attachments(&self) -> Vec<vk::AttachmentDescription> {
        let describe = |(format, samples)| {
            vk::AttachmentDescription::default()
                .format(format)
                .samples(samples)
                .load_op(vk::AttachmentLoadOp::CLEAR)
                .store_op(vk::AttachmentStoreOp::STORE)
                .stencil_load_op(vk::AttachmentLoadOp::CLEAR)
                .final_layout(vk::ImageLayout::TRANSFER_SRC_OPTIMAL)
        };
        self.formats().into_iter().map(describe).collect()
    }

    /// The host's render pass for the engine.
    pub fn host_pass<'a>(&self, attachments: &'a [vk::AttachmentDescription]) -> HostRenderPass<'a> {
        let AttachmentIndices { depth, normals, resolved } = self.attachment_indices();
        let [before, after] = self.around;
        HostRenderPass {
            attachments,
            subpasses: [before.into(), after.into()],
            picture: 0,
            // The last subpass resolves.
            resolve: resolved.filter(|_| !after),
            normal: normals,
            depth: depth.map(|attachment| Depth { attachment, reversed: self.reversed, seed: self.seed }),
            encode: false,
        }
    }
}

impl Native {
    /// Creates frames of `size` px for scenes with these streams and settings.
    pub fn new(
        host: &Host,
        device: &Arc<Device>,
        kind: Kind,
        size: [u32; 2],
        frames: &[(Streams, &Settings)],
    ) -> Result<Self> {
        let mut attachments = kind.attachments();
        let plan = Plan::new(device, &kind.host_pass(&attachments), Precision::Full, frames)?;
        attachments.extend(plan.attachments());
        let far = if kind.reversed { 0.0 } else { 1.0 };
        let mut clears = vec![vk::ClearValue::default(); kind.formats().len()];
        if let Some(depth) = kind.attachment_indices().depth {
            clears[depth as usize].depth_stencil = vk::ClearDepthStencilValue { depth: far, stencil: 0 };
        }
        clears.extend(plan.clear_values());
        let pass = render_pass(host, kind, &attachments, &plan)?;
        let fog = kind.around[1].then(|| Fog::new(host, (pass, plan.last() + 1), kind.samples));
        // SAFETY: the pass has the plan's additions and outlives the renderer.
        let mut renderer = unsafe { Renderer::new(device, plan, pass, 2)? };
        let framed = Framed::new(host, kind, pass, &mut renderer, size)?;
        let native = Self { renderer, kind, pass, fog: fog.transpose()?, framed, clears };
        native.bind_depth(host);
        Ok(native)
    }

    /// Sets the colour before the mesh, at first transparent black.
    pub fn clear_to(&mut self, colour: [f32; 4]) {
        self.clears[0].color.float32 = colour;
    }

    /// Changes the size; no frame is in flight.
    pub fn resize(&mut self, host: &Host, size: [u32; 2]) -> Result<()> {
        let framed = Framed::new(host, self.kind, self.pass, &mut self.renderer, size)?;
        std::mem::replace(&mut self.framed, framed).destroy(host);
        self.bind_depth(host);
        Ok(())
    }

    fn bind_depth(&self, host: &Host) {
        if let (Some(fog), Some(view)) = (&self.fog, self.framed.depth_view) {
            fog.read(host, view);
        }
    }

    /// Target of the host's pipelines before the surfels.
    pub fn mesh_target(&self) -> MeshTarget<'_> {
        MeshTarget {
            pass: self.pass,
            subpass: 0,
            formats: None,
            samples: self.kind.samples,
            colours: 1,
            reversed: self.kind.reversed,
        }
    }

    /// Records the render pass: the mesh with the direction to its light, if any; the surfels, drawn by `surfels`; and the fog, if any.
    pub fn record(
        &self,
        host: &Host,
        cmd: vk::CommandBuffer,
        (mesh, view): (Option<(&Mesh, Vec3)>, &View),
        surfels: impl FnOnce(&Renderer) -> surfel::Result<()>,
        foggy: bool,
    ) -> Result<()> {
        let [width, height] = self.framed.size;
        let info = vk::RenderPassBeginInfo::default()
            .render_pass(self.pass)
            .framebuffer(self.framed.framebuffer)
            .render_area(vk::Rect2D { extent: vk::Extent2D { width, height }, ..Default::default() })
            .clear_values(&self.clears);
        // SAFETY: recorded outside a render pass.
        unsafe { host.device.cmd_begin_render_pass(cmd, &info, vk::SubpassContents::INLINE) };
        if let Some((mesh, to_light)) = mesh.filter(|_| self.kind.around[0]) {
            mesh.draw(host, cmd, view.viewport, view.camera.world_to_clip().as_mat4(), to_light);
        }
        let drawn = surfels(&self.renderer);
        if drawn.is_err() {
            // SAFETY: inside the render pass, before the plan's first subpass.
            unsafe { self.renderer.skip(cmd) };
        }
        // SAFETY: the command buffer is in the engine's last subpass.
        unsafe {
            if let Some(fog) = &self.fog {
                host.device.cmd_next_subpass(cmd, vk::SubpassContents::INLINE);
                if foggy {
                    fog.draw(host, cmd, self.framed.size);
                }
            }
            host.device.cmd_end_render_pass(cmd);
        }
        Ok(drawn?)
    }

    /// The picture, `bytes` per pixel.
    pub fn picture(&self, host: &Host, bytes: usize) -> Result<Vec<u8>> {
        self.picture_target().read(host, bytes)
    }

    /// The image of the picture, a transfer source after the pass.
    pub fn image(&self) -> vk::Image {
        self.picture_target().image
    }

    /// The single-sample picture, a transfer source after the pass.
    pub fn picture_target(&self) -> &Target {
        &self.framed.targets[self.kind.attachment_indices().resolved.unwrap_or(0) as usize]
    }

    /// The depth, a transfer source after the pass, and a view of its depth aspect.
    pub fn depth(&self) -> Option<(&Target, vk::ImageView)> {
        let number = self.kind.attachment_indices().depth?;
        Some((&self.framed.targets[number as usize], self.framed.depth_view?))
    }

    /// The single-sample depths, `bytes` per pixel.
    pub fn depths(&self, host: &Host, bytes: usize) -> Result<Vec<u8>> {
        let number = self.kind.attachment_indices().depth.ok_or("there is no depth")?;
        self.framed.targets[number as usize].read(host, bytes)
    }

    /// The depths, of any format.
    pub fn read_depths(&self, host: &Host) -> Result<Vec<f64>> {
        let number = self.kind.attachment_indices().depth.ok_or("there is no depth")?;
        self.framed.targets[number as usize].read_depths(host)
    }

    /// The normals.
    pub fn normals(&self, host: &Host) -> Result<Vec<u8>> {
        let number = self.kind.attachment_indices().normals.ok_or("there are no normals")?;
        self.framed.targets[number as usize].read(host, 16)
    }

    /// Destroys it, once the GPU has finished using it.
    pub fn destroy(self, host: &Host) {
        drop(self.renderer);
        if let Some(fog) = self.fog {
            fog.destroy(host);
        }
        self.framed.destroy(host);
        // SAFETY: by the caller.
        unsafe { host.device.destroy_render_pass(self.pass, None) };
    }
}

impl Framed {
    fn new(
        host: &Host,
        kind: Kind,
        pass: vk::RenderPass,
        renderer: &mut Renderer,
        size: [u32; 2],
    ) -> Result<Self> {
        use vk::ImageUsageFlags as Usage;
        let input = if kind.seed || kind.around[1] { Usage::INPUT_ATTACHMENT } else { Usage::empty() };
        let target = |(format, samples)| {
            let usage = if Some(format) == kind.depth {
                Usage::DEPTH_STENCIL_ATTACHMENT | Usage::SAMPLED | input
            } else {
                Usage::COLOR_ATTACHMENT
            };
            Target::new(host, format, size, samples, usage | Usage::TRANSFER_SRC)
        };
        let targets: Vec<_> = kind.formats().into_iter().map(target).collect::<Result<_>>()?;
        let depth = kind.attachment_indices().depth.map(|depth| &targets[depth as usize]);
        let depth_view = depth.map(|depth| depth.depth_view(host)).transpose()?;
        // SAFETY: the view is of the depth aspect only.
        let added = unsafe { renderer.resize(size, depth_view)? };
        let views: Vec<_> = targets.iter().map(|target| target.view).chain(added).collect();
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(pass)
            .attachments(&views)
            .width(size[0])
            .height(size[1])
            .layers(1);
        // SAFETY: plain Vulkan; `destroy` destroys the framebuffer.
        let framebuffer = unsafe { host.device.create_framebuffer(&info, None)? };
        Ok(Self { size, targets, depth_view, framebuffer })
    }

    fn destroy(self, host: &Host) {
        // SAFETY: no frame is in flight.
        unsafe {
            host.device.destroy_framebuffer(self.framebuffer, None);
            self.depth_view.into_iter().for_each(|view| host.device.destroy_image_view(view, None));
        }
        self.targets.into_iter().for_each(|target| target.destroy(host));
    }
}

/// The host's subpasses around those of the plan.
fn render_pass(
    host: &Host,
    kind: Kind,
    attachments: &[vk::AttachmentDescription],
    plan: &Plan,
) -> Result<vk::RenderPass> {
    let AttachmentIndices { depth, resolved, .. } = kind.attachment_indices();
    let reference = |attachment, layout| vk::AttachmentReference { attachment, layout };
    let colour = [reference(0, DRAWN)];
    let tested = depth.map(|depth| reference(depth, TESTED));
    let seen: Vec<_> = depth.map(|depth| reference(depth, SEEN)).into_iter().collect();
    let resolves: Vec<_> = resolved.map(|resolved| reference(resolved, DRAWN)).into_iter().collect();
    let subpass = || {
        vk::SubpassDescription::default()
            .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
            .color_attachments(&colour)
    };
    let mut meshes = subpass();
    if let Some(tested) = &tested {
        meshes = meshes.depth_stencil_attachment(tested);
    }
    let mut fog = subpass().input_attachments(&seen);
    if !resolves.is_empty() {
        fog = fog.resolve_attachments(&resolves);
    }
    let [before, after] = kind.around;
    let subpasses: Vec<_> =
        before.then_some(meshes).into_iter().chain(plan.subpasses()).chain(after.then_some(fog)).collect();
    let mut dependencies = plan.dependencies();
    // Consecutive frames use the same targets, which are copied from.
    use vk::{AccessFlags as Access, PipelineStageFlags as Stages};
    let tests = Stages::EARLY_FRAGMENT_TESTS | Stages::LATE_FRAGMENT_TESTS;
    let drawing = Stages::COLOR_ATTACHMENT_OUTPUT | tests;
    let drawn = Access::COLOR_ATTACHMENT_WRITE | Access::DEPTH_STENCIL_ATTACHMENT_WRITE;
    let seen = Access::COLOR_ATTACHMENT_READ | Access::DEPTH_STENCIL_ATTACHMENT_READ;
    let outside = vk::SUBPASS_EXTERNAL;
    let last = subpasses.len() as u32 - 1;
    let begin = vk::SubpassDependency::default()
        .src_subpass(outside)
        .src_stage_mask(Stages::TRANSFER | Stages::FRAGMENT_SHADER | drawing)
        .src_access_mask(drawn)
        .dst_subpass(0)
        .dst_stage_mask(drawing)
        .dst_access_mask(drawn | seen);
    let end = vk::SubpassDependency::default()
        .src_subpass(last)
        .src_stage_mask(drawing)
        .src_access_mask(drawn)
        .dst_subpass(outside)
        .dst_stage_mask(Stages::TRANSFER)
        .dst_access_mask(Access::TRANSFER_READ);
    dependencies.extend([begin, end]);
    let info = vk::RenderPassCreateInfo::default()
        .attachments(attachments)
        .subpasses(&subpasses)
        .dependencies(&dependencies);
    // SAFETY: plain Vulkan.
    Ok(unsafe { host.device.create_render_pass(&info, None)? })
}
