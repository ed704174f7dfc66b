//! What a frame is drawn to before the window has it: colours in linear float, and depth, of any size.
#![allow(unsafe_code, reason = "it is a host of `embed`, which is one of Vulkan")]

use ash::vk;
use glam::DVec2;
use std::sync::Arc;
use surfel::embed::{self, Options, Pass, Target, View};
use surfel::geometry::Camera;
use surfel::vk::{
    Access, Attachment, Buffer, Device, FRAMES_IN_FLIGHT, Framebuffer, Image, ImageUse, Presented, Recorder,
    RenderPass,
};
use surfel::{Precision, Rasterizer, Result, Scene, Settings};

/// Renders scenes and shows them.
pub struct Screen {
    // Fields are dropped in this order: what frames under way may use goes when the presenter, which waits for them, is gone.
    renderer: embed::Renderer,
    targets: Option<Targets>,
    /// What the frame before may use, where its size was another.
    old: Option<Targets>,
    pass: RenderPass,
    device: Arc<Device>,
}

struct Targets {
    framebuffer: Framebuffer,
    colour: Image,
    depth: Image,
    /// Where depths are read back.
    depths: Buffer,
}

/// A place in a window's picture.
#[derive(Clone, Copy, Debug)]
pub struct Pick {
    /// Px.
    pub at: DVec2,
    /// Width and height of the picture, px.
    pub size: [u32; 2],
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
            id: None,
            encode: false,
        };
        let options =
            Options { target, frames_in_flight: FRAMES_IN_FLIGHT, precision: Precision::Full, rasterizer };
        // SAFETY: the target is this pass, which goes after the renderer.
        let renderer = unsafe { embed::Renderer::new(device, options)? };
        Ok(Self { renderer, targets: None, old: None, pass, device: device.clone() })
    }

    /// Makes targets of this size where there are others.
    fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        // The GPU is done with all but the last frame.
        self.old = None;
        if self.targets.as_ref().is_none_or(|targets| targets.colour.size() != size) {
            let made = Targets::new(&self.device, &self.pass, size)?;
            self.old = self.targets.replace(made);
        }
        Ok(())
    }

    /// Records a frame of `scene`, if there is one, of `size` px into the window's. After an error that is empty.
    pub fn record(
        &mut self,
        window: &Presented,
        size: [u32; 2],
        scene: Option<(&Arc<Scene>, &Camera, &Settings)>,
    ) -> Result<()> {
        self.resize(size)?;
        let Some(Targets { framebuffer, colour, depth, depths }) = &self.targets else { return Ok(()) };
        let [width, height] = colour.size().map(|side| side as f32);
        let viewport = vk::Viewport { x: 0.0, y: 0.0, width, height, min_depth: 0.0, max_depth: 1.0 };
        let mut drawn = Ok(());
        if let Some((scene, camera, settings)) = scene {
            let view = View { camera: *camera, viewport };
            // SAFETY: the presenter's command buffer is being recorded, and it submits in order; as many frames are under way as it says.
            drawn = unsafe { self.renderer.prepare(window.cmd, scene, &view, settings) };
        }
        // SAFETY: as above.
        let mut rec = unsafe { Recorder::of_host(&self.device, window.cmd) };
        let uses = [colour.with(Access::COLOUR_WRITE), depth.with(Access::DEPTH_WRITE)];
        rec.pass("screen", &uses, |enc| {
            enc.render(framebuffer, |_| {
                if scene.is_some() && drawn.is_ok() {
                    // SAFETY: within the renderer's target.
                    drawn = unsafe { self.renderer.draw(window.cmd) };
                }
            });
        });
        rec.pass("show", &[colour.with(Access::COPY_READ)], |enc| enc.show(colour, window));
        let uses = [depth.with(Access::COPY_READ), depths.with(Access::COPY_WRITE)];
        rec.pass("depths", &uses, |enc| enc.copy_image(depth, depths));
        rec.wait(&[depths.with(Access::HOST_READ)]);
        drawn
    }

    /// The depth of the last frame at a place, which must be over; `None` where nothing is.
    pub fn pick(&self, Pick { at, size }: Pick) -> Option<f64> {
        let Targets { colour, depths, .. } = self.targets.as_ref()?;
        let own = colour.size();
        let part = at / DVec2::from(size.map(f64::from));
        let [x, y] = [0, 1].map(|axis| {
            let place = (part[axis] * f64::from(own[axis])).floor();
            (place >= 0.0 && place < f64::from(own[axis])).then_some(place as usize)
        });
        let first = 4 * (y? * own[0] as usize + x?);
        let bytes = depths.bytes().get(first..first + 4)?;
        let depth = f32::from_ne_bytes(bytes.try_into().ok()?);
        (depth > 0.0).then_some(depth.into())
    }
}

impl Targets {
    fn new(device: &Arc<Device>, pass: &RenderPass, size: [u32; 2]) -> Result<Self> {
        let colour = Image::target(device, "screen", COLOUR, size, ImageUse::Output)?;
        let depth = Image::target(device, "screen depth", DEPTH, size, ImageUse::Output)?;
        let pixels = u64::from(size[0]) * u64::from(size[1]);
        Ok(Self {
            framebuffer: Framebuffer::new(device, pass, &[&colour, &depth])?,
            depths: Buffer::readback(device, "screen depths", 4 * pixels)?,
            colour,
            depth,
        })
    }
}
