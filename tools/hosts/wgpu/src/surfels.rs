//! Surfels between two passes of wgpu: a raw Vulkan render pass on wgpu's textures, in a separate encoder.
//!
//! wgpu does not allow other code inside its passes, but it documents the state in which it leaves a texture; the raw commands leave it in
//! the same state.

use crate::Result;
use crate::frame::{COLOUR, Frame};
use crate::gpu::Gpu;
use ash::vk;
use std::sync::Arc;
use surfel::embed::{self, Options, Pass, Renderer, Target, View};
use surfel::geometry::{Camera, Surfels};
use surfel::vk::Device;
use surfel::{Scene, Settings};
use wgpu::hal::vulkan::Api as Vulkan;

/// Surfels and their renderer for frames of wgpu. The GPU must have finished using it when it is dropped.
pub struct Embedded {
    // Drop order: the render pass after the objects that use it, and wgpu's device last.
    renderer: Renderer,
    scene: Arc<Scene>,
    /// wgpu's device, imported into the engine.
    device: Arc<Device>,
    attached: Option<Attached>,
    pass: RawPass,
    _device: wgpu::Device,
}

/// A frame's textures, as attachments.
struct Attached {
    framebuffer: vk::Framebuffer,
    _views: [wgpu::TextureView; 2],
    size: [u32; 2],
    device: ash::Device,
}

/// The render pass.
struct RawPass {
    raw: vk::RenderPass,
    device: ash::Device,
}

/// Number of frames in flight.
pub const FRAMES_IN_FLIGHT: u32 = 2;

const LAYOUTS: [vk::ImageLayout; 2] =
    [vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL, vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL];
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

impl Embedded {
    /// Uploads `surfels`, for frames with `samples` samples per pixel.
    pub fn new(gpu: &Gpu, surfels: &Surfels, samples: u32) -> Result<Self> {
        let device = gpu.external_device()?;
        let scene = upload(gpu, &device, surfels)?;
        // SAFETY: nothing of wgpu's is destroyed.
        let (raw_device, colour) = unsafe {
            let device = gpu.device.as_hal::<Vulkan>().ok_or("wgpu does not use Vulkan")?;
            let adapter = gpu.adapter.as_hal::<Vulkan>().ok_or("wgpu does not use Vulkan")?;
            (device.raw_device().clone(), adapter.texture_format_as_raw(COLOUR))
        };
        let samples = vk::SampleCountFlags::from_raw(samples);
        let pass = RawPass { raw: render_pass(&raw_device, colour, samples)?, device: raw_device };
        let target = Target {
            pass: Pass::Subpass { pass: pass.raw, subpass: 0 },
            colours: vec![colour],
            depth: Some(DEPTH),
            stencil: vk::Format::UNDEFINED,
            reversed: true,
            write_depth: true,
            samples,
            picture: 0,
            normal: None,
            id: None,
            encode: false,
        };
        let options = Options { frames_in_flight: FRAMES_IN_FLIGHT, ..Options::new(target) };
        // SAFETY: the target is this pass, which outlives the renderer.
        let renderer = unsafe { Renderer::new(&device, options)? };
        Ok(Self { renderer, scene, device, attached: None, pass, _device: gpu.device.clone() })
    }

    /// Shows other surfels from the next frame on; the renderer keeps those of frames in flight.
    pub fn set_surfels(&mut self, gpu: &Gpu, surfels: &Surfels) -> Result<()> {
        self.scene = upload(gpu, &self.device, surfels)?;
        Ok(())
    }

    /// Draws the surfels into `frame` from now on. The GPU has finished the frames before.
    pub fn attach(&mut self, frame: &Frame) -> Result<()> {
        let views = [&frame.colour, &frame.depth].map(|texture| texture.create_view(&Default::default()));
        // SAFETY: wgpu's views are kept as long as the framebuffer.
        let raw = unsafe {
            let raw = |view: &wgpu::TextureView| view.as_hal::<Vulkan>().map(|view| view.raw_handle());
            [raw(&views[0]).ok_or("no view")?, raw(&views[1]).ok_or("no view")?]
        };
        let [width, height] = frame.size;
        let info = vk::FramebufferCreateInfo::default()
            .render_pass(self.pass.raw)
            .attachments(&raw)
            .width(width)
            .height(height)
            .layers(1);
        let device = self.pass.device.clone();
        // SAFETY: plain Vulkan; `drop` destroys the framebuffer.
        let framebuffer = unsafe { device.create_framebuffer(&info, None)? };
        self.attached = Some(Attached { framebuffer, _views: views, size: frame.size, device });
        Ok(())
    }

    /// Commands that draw the surfels, to be submitted between two passes of wgpu on the frame: its textures are colour and depth targets
    /// before and after.
    pub fn record(&mut self, gpu: &Gpu, camera: &Camera, settings: &Settings) -> Result<wgpu::CommandBuffer> {
        let Some(Attached { framebuffer, size: [width, height], device, .. }) = &self.attached else {
            return Err("surfels without a frame".into());
        };
        // wgpu flips its viewports: y points up.
        let (width, height) = (*width, *height);
        let viewport = vk::Viewport {
            x: 0.0,
            y: height as f32,
            width: width as f32,
            height: -(height as f32),
            min_depth: 0.0,
            max_depth: 1.0,
        };
        let view = View { camera: *camera, viewport };
        let area = vk::Rect2D { offset: vk::Offset2D::default(), extent: vk::Extent2D { width, height } };
        let begin = vk::RenderPassBeginInfo::default()
            .render_pass(self.pass.raw)
            .framebuffer(*framebuffer)
            .render_area(area);
        let mut encoder =
            gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("surfels") });
        // SAFETY: prepared outside the pass and drawn inside it; the commands are submitted to the only queue in the order of recording,
        // and the caller limits the frames in flight to the declared number.
        unsafe {
            encoder.as_hal_mut::<Vulkan, _, _>(|raw| {
                let cmd = raw.ok_or("wgpu does not record")?.raw_handle();
                self.renderer.prepare(cmd, &self.scene, &view, settings)?;
                device.cmd_begin_render_pass(cmd, &begin, vk::SubpassContents::INLINE);
                let drawn = self.renderer.draw(cmd);
                device.cmd_end_render_pass(cmd);
                Ok::<_, Box<dyn std::error::Error>>(drawn?)
            })?;
        }
        Ok(encoder.finish())
    }
}

/// Uploads surfels to the device.
fn upload(gpu: &Gpu, device: &Arc<Device>, surfels: &Surfels) -> Result<Arc<Scene>> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    // SAFETY: recorded outside a render pass; the staging memory is kept until the GPU has finished.
    let (scene, staging) = unsafe {
        encoder.as_hal_mut::<Vulkan, _, _>(|raw| {
            let cmd = raw.ok_or("wgpu does not record")?.raw_handle();
            Ok::<_, Box<dyn std::error::Error>>(embed::upload(device, cmd, surfels)?)
        })?
    };
    gpu.queue.submit([encoder.finish()]);
    gpu.wait(None)?;
    drop(staging);
    Ok(Arc::new(scene))
}

impl Drop for Attached {
    fn drop(&mut self) {
        // SAFETY: the caller of `attach` and `drop` guarantees that the GPU has finished using it.
        unsafe { self.device.destroy_framebuffer(self.framebuffer, None) };
    }
}

impl Drop for RawPass {
    fn drop(&mut self) {
        // SAFETY: as above, and the objects that use it are destroyed.
        unsafe { self.device.destroy_render_pass(self.raw, None) };
    }
}

/// A render pass over wgpu's output that keeps its textures in the layouts of wgpu's passes.
fn render_pass(
    device: &ash::Device,
    colour: vk::Format,
    samples: vk::SampleCountFlags,
) -> Result<vk::RenderPass> {
    let attachments = [colour, DEPTH].into_iter().zip(LAYOUTS).map(|(format, layout)| {
        vk::AttachmentDescription::default()
            .format(format)
            .samples(samples)
            .load_op(vk::AttachmentLoadOp::LOAD)
            .store_op(vk::AttachmentStoreOp::STORE)
            .initial_layout(layout)
            .final_layout(layout)
    });
    let attachments: Vec<_> = attachments.collect();
    let [colour, depth] =
        [0, 1].map(|i| vk::AttachmentReference { attachment: i, layout: LAYOUTS[i as usize] });
    let colours = [colour];
    let subpass = [vk::SubpassDescription::default()
        .pipeline_bind_point(vk::PipelineBindPoint::GRAPHICS)
        .color_attachments(&colours)
        .depth_stencil_attachment(&depth)];
    let dependencies = dependencies();
    let info = vk::RenderPassCreateInfo::default()
        .attachments(&attachments)
        .subpasses(&subpass)
        .dependencies(&dependencies);
    // SAFETY: plain Vulkan; `drop` destroys the pass.
    Ok(unsafe { device.create_render_pass(&info, None)? })
}

/// The pass waits for wgpu's before it and blocks those after it: wgpu inserts no barrier there, because for it the textures do not change.
fn dependencies() -> [vk::SubpassDependency; 2] {
    use vk::{AccessFlags as Access, PipelineStageFlags as Stages};
    let stages = Stages::COLOR_ATTACHMENT_OUTPUT | Stages::EARLY_FRAGMENT_TESTS | Stages::LATE_FRAGMENT_TESTS;
    let writes = Access::COLOR_ATTACHMENT_WRITE | Access::DEPTH_STENCIL_ATTACHMENT_WRITE;
    let reads = Access::COLOR_ATTACHMENT_READ | Access::DEPTH_STENCIL_ATTACHMENT_READ;
    [[vk::SUBPASS_EXTERNAL, 0], [0, vk::SUBPASS_EXTERNAL]].map(|[from, to]| vk::SubpassDependency {
        src_subpass: from,
        dst_subpass: to,
        src_stage_mask: stages,
        dst_stage_mask: stages,
        src_access_mask: writes,
        dst_access_mask: writes | reads,
        dependency_flags: vk::DependencyFlags::empty(),
    })
}
