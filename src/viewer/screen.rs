//! What a frame is drawn to before the window has it: colours in linear float, and depth, of any size.
#![allow(unsafe_code, reason = "it is a host of `embed`, which is one of Vulkan")]

use ash::vk;
use std::sync::Arc;
use surfel::embed::{self, Options, Pass, Target, View};
use surfel::geometry::Camera;
use surfel::vk::{
    Access, Attachment, Device, FRAMES_IN_FLIGHT, Framebuffer, Image, ImageUse, Presented, Recorder,
    RenderPass,
};
use surfel::{Precision, Rasterizer, Result, Scene, Settings};

/// Renders scenes and shows them.
pub struct Screen {
    // Fields are dropped in this order: what frames under way may use goes when the presenter, which waits for them, is gone.
    renderer: embed::Renderer,
    targets: Option<Targets>,
    pass: RenderPass,
    device: Arc<Device>,
}

struct Targets {
    framebuffer: Framebuffer,
    colour: Image,
    depth: Image,
}

const COLOUR: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

impl Screen {
    pub fn new(device: &Arc<Device>, rasterizer: Option<Rasterizer>) -> Result<Self> {
        let pass = RenderPass::new(device, &[Attachment::Cleared(COLOUR)], Some(Attachment::Cleared(DEPTH)))?;
        let target = Target {
            pass: Pass::Subpass { pass: pass.handle(), subpass: 0 },
            colours: vec![COLOUR],
            depth: Some(DEPTH),
            stencil: vk::Format::UNDEFINED,
            reversed: true,
            samples: vk::SampleCountFlags::TYPE_1,
            picture: 0,
            normal: None,
            encode: false,
        };
        let options =
            Options { target, frames_in_flight: FRAMES_IN_FLIGHT, precision: Precision::Full, rasterizer };
        // SAFETY: the target is this pass, which goes after the renderer.
        let renderer = unsafe { embed::Renderer::new(device, options)? };
        Ok(Self { renderer, targets: None, pass, device: device.clone() })
    }

    /// Makes targets of this size where there are others; frames are over then.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        if self.targets.as_ref().is_none_or(|targets| targets.colour.size() != size) {
            self.targets = None;
            let colour = Image::target(&self.device, "screen", COLOUR, size, ImageUse::Output)?;
            let depth = Image::target(&self.device, "screen depth", DEPTH, size, ImageUse::Output)?;
            let framebuffer = Framebuffer::new(&self.device, &self.pass, &[&colour, &depth])?;
            self.targets = Some(Targets { framebuffer, colour, depth });
        }
        Ok(())
    }

    /// Records a frame of `scene`, if there is one, into the window's.
    pub fn record(
        &mut self,
        window: &Presented,
        scene: Option<(&Arc<Scene>, &Camera, &Settings)>,
    ) -> Result<()> {
        let Some(Targets { framebuffer, colour, depth }) = &self.targets else { return Ok(()) };
        let [width, height] = colour.size().map(|side| side as f32);
        let viewport = vk::Viewport { x: 0.0, y: 0.0, width, height, min_depth: 0.0, max_depth: 1.0 };
        if let Some((scene, camera, settings)) = scene {
            let view = View { camera: *camera, viewport };
            // SAFETY: the presenter's command buffer is being recorded, and it submits in order; as many frames are under way as it says.
            unsafe { self.renderer.prepare(window.cmd, scene, &view, settings)? };
        }
        // SAFETY: as above.
        let mut rec = unsafe { Recorder::of_host(&self.device, window.cmd) };
        let mut drawn = Ok(());
        let uses = [colour.with(Access::COLOUR_WRITE), depth.with(Access::DEPTH_WRITE)];
        rec.pass("screen", &uses, |enc| {
            enc.render(framebuffer, |_| {
                if scene.is_some() {
                    // SAFETY: within the renderer's target.
                    drawn = unsafe { self.renderer.draw(window.cmd) };
                }
            });
        });
        rec.pass("show", &[colour.with(Access::COPY_READ)], |enc| enc.show(colour, window));
        drawn
    }
}
