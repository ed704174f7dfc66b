//! A picture of a scene before the window has it: colours in linear float, and depth, of any size. It is drawn anew only where something else is
//! to be seen.
#![allow(unsafe_code, reason = "it is a host of `embed`, which is one of Vulkan")]

use ash::vk;
use std::sync::Arc;
use surfel::embed::{self, Measured, Options, Pass, Target, View};
use surfel::geometry::Camera;
use surfel::vk::{
    Access, Buffer, Device, FRAMES_IN_FLIGHT, Framebuffer, Image, ImageUse, Presented, Recorder, RenderPass,
    Timestamps,
};
use surfel::{FrameReport, Precision, Rasterizer, Result, Scene, Settings};

/// Formats of the targets.
pub const COLOUR: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
pub const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// One picture of the window.
pub struct Side {
    // Fields are dropped in this order: what frames under way may use goes when the presenter, which waits for them, is gone.
    renderer: embed::Renderer,
    targets: Option<Targets>,
    /// What the frame before may use, where its size was another.
    old: Option<Targets>,
    /// What the targets show.
    drawn: Option<Seen>,
    timestamps: Option<Timestamps>,
    /// Whether a frame that is measured has not told yet.
    measured: bool,
    device: Arc<Device>,
}

/// What is to be seen.
#[derive(Clone)]
pub struct Seen {
    pub scene: Arc<Scene>,
    pub camera: Camera,
    pub settings: Settings,
    /// Width and height of the picture, px.
    pub size: [u32; 2],
    /// Another for the same scene with other contents.
    pub version: u64,
    /// Whether the frame tells its times and counts.
    pub measured: bool,
}

struct Targets {
    framebuffer: Framebuffer,
    colour: Image,
    depth: Image,
    /// Where depths are read back.
    depths: Buffer,
}

impl Seen {
    fn is_as(&self, other: &Self) -> bool {
        let frame = |seen: &Self| (seen.camera, seen.size, seen.version);
        Arc::ptr_eq(&self.scene, &other.scene)
            && frame(self) == frame(other)
            && self.settings == other.settings
            && (other.measured || !self.measured)
    }
}

impl Side {
    /// Draws within `pass`, which goes after it.
    pub fn new(device: &Arc<Device>, pass: &RenderPass, rasterizer: Option<Rasterizer>) -> Result<Self> {
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
        let device = device.clone();
        let (drawn, timestamps) = (None, None);
        Ok(Self { renderer, targets: None, old: None, drawn, timestamps, measured: false, device })
    }

    /// Records the picture, unless it is there; whether it was not. After an error it is empty.
    pub fn record(&mut self, window: &Presented, pass: &RenderPass, seen: Option<&Seen>) -> Result<bool> {
        // The GPU is done with all but the last frame.
        self.old = None;
        let same = seen.zip(self.drawn.as_ref()).is_some_and(|(seen, drawn)| seen.is_as(drawn));
        if same {
            return Ok(false);
        }
        self.drawn = None;
        let size = seen.map_or(window.size, |seen| seen.size);
        if self.targets.as_ref().is_none_or(|targets| targets.colour.size() != size) {
            let made = Targets::new(&self.device, pass, size)?;
            self.old = self.targets.replace(made);
        }
        self.draw(window, seen)?;
        self.drawn = seen.cloned();
        Ok(seen.is_some())
    }

    fn draw(&mut self, window: &Presented, seen: Option<&Seen>) -> Result<()> {
        let Some(targets) = &self.targets else { return Ok(()) };
        let measured = seen.is_some_and(|seen| seen.measured) && !self.measured;
        let mut drawn = Ok(());
        if let Some(Seen { scene, camera, settings, .. }) = seen {
            let view = View { camera: *camera, viewport: targets.viewport() };
            self.renderer.measure(Measured { times: measured, counts: measured });
            // SAFETY: the presenter's command buffer is being recorded, and it submits in order; as many frames are under way as it says.
            drawn = unsafe { self.renderer.prepare(window.cmd, scene, &view, settings) };
        }
        if measured && self.timestamps.is_none() {
            self.timestamps = Timestamps::new(&self.device)?;
        }
        self.measured |= measured;
        let timestamps = self.timestamps.as_mut().filter(|_| measured);
        // SAFETY: as above; what was measured before has told, so that it is over.
        let mut rec = unsafe { Recorder::of_host_timed(&self.device, window.cmd, timestamps) };
        let Targets { framebuffer, colour, depth, depths } = targets;
        let uses = [colour.with(Access::COLOUR_WRITE), depth.with(Access::DEPTH_WRITE)];
        let [r, g, b] = seen.and_then(|seen| seen.settings.background).unwrap_or_default();
        rec.pass("screen", &uses, |enc| {
            enc.render_over(framebuffer, [r, g, b, 1.0], |_| {
                if seen.is_some() && drawn.is_ok() {
                    // SAFETY: within the renderer's target.
                    drawn = unsafe { self.renderer.draw(window.cmd) };
                }
            });
        });
        let uses = [depth.with(Access::COPY_READ), depths.with(Access::COPY_WRITE)];
        rec.pass("depths", &uses, |enc| enc.copy_image(depth, depths));
        rec.wait(&[depths.with(Access::HOST_READ), colour.with(Access::COPY_READ)]);
        drawn
    }

    /// Shows the columns between two parts of the width in the window.
    pub fn show(&self, rec: &mut Recorder<'_>, window: &Presented, columns: [f64; 2]) {
        let Some(Targets { colour, .. }) = &self.targets else { return };
        let uses = [colour.with(Access::COPY_READ)];
        rec.left(&uses);
        rec.pass("show", &uses, |enc| enc.show_part(colour, window, columns));
    }

    /// What the last frame, which must be over, tells, once; `None` where it was not measured.
    pub fn report(&mut self) -> Result<Option<FrameReport>> {
        if !std::mem::take(&mut self.measured) {
            return Ok(None);
        }
        // SAFETY: by the caller's word, every frame is over.
        unsafe { self.renderer.finish()? };
        let own = self.timestamps.as_ref().map_or(Ok(Vec::new()), Timestamps::read)?;
        let report = self.renderer.report().cloned();
        Ok(report.map(|mut report| {
            report.pass_times.extend(own);
            report
        }))
    }

    /// Width and height, and the depths row by row, of the last frame, which must be over.
    pub fn depths(&self) -> Option<([u32; 2], &[u8])> {
        self.targets.as_ref().map(|targets| (targets.colour.size(), targets.depths.bytes()))
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

    fn viewport(&self) -> vk::Viewport {
        let [width, height] = self.colour.size().map(|side| side as f32);
        vk::Viewport { x: 0.0, y: 0.0, width, height, min_depth: 0.0, max_depth: 1.0 }
    }
}
