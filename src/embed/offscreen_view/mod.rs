//! Offscreen view: a picture of a scene in frames of a window, with colours and depth, of any size.

mod colour_map;
mod range;
mod scalar_colours;

use super::{Measured, Options, Pass, Renderer, Target, View};
use crate::error::{Error, Result};
use crate::frame::FrameReport;
use crate::geometry::{Camera, ValueRange};
use crate::scene::Scene;
use crate::settings::RasterizerChoice;
use crate::settings::Settings;
use crate::vk::{
    Access, Attachment, Buffer, Device, FRAMES_IN_FLIGHT, Framebuffer, Image, ImageUse, Presented, Presenter,
    Recorder, RenderPass, Stake, Timestamps,
};
use ash::vk;
use scalar_colours::{ScalarColours, is_scalar};
use std::cell::RefCell;
use std::sync::Arc;

/// Format of the scalars of a picture that shows these; other pictures have the window's format.
const SCALARS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// A picture in frames of one [`Presenter`]. It is kept until it is drawn again. It upholds the safety rules of [`Renderer`]: it draws in
/// frames of that presenter only, once in each, and waits for the GPU on drop; a frame that is being recorded at that time is not
/// submitted.
pub struct OffscreenView {
    // Drop order: views before their resources, and the pass after all framebuffers.
    /// Colours of a scalar picture.
    scalar_colours: Option<ScalarColours>,
    targets: Option<Targets>,
    target_renderer: TargetRenderer,
    /// Resources of frames in flight, each with the number of the last frame that may use it.
    old: Vec<(u64, DeferredResources)>,
    timestamps: Option<Timestamps>,
    /// Whether a measured frame is not reported yet.
    measured: bool,
    /// Number of the frame in which it was drawn last.
    drawn: Option<u64>,
    /// Number of the last frame that it recorded into, and its stake in that frame.
    stake: RefCell<Option<(u64, Arc<Stake>)>>,
    /// Id of the presenter.
    presenter: u64,
    rasterizer: RasterizerChoice,
    device: Arc<Device>,
}

/// The renderer into targets of one format, with its render pass.
struct TargetRenderer {
    renderer: Renderer,
    pass: RenderPass,
    format: vk::Format,
}

/// A scene with camera and settings.
pub type SceneView<'a> = (&'a Arc<Scene>, &'a Camera, &'a Settings);

/// Resources that are replaced.
#[derive(Default)]
struct DeferredResources {
    // Views before their resources.
    _scalar_colours: Option<ScalarColours>,
    _targets: Option<Targets>,
    _target_renderer: Option<TargetRenderer>,
}

struct Targets {
    framebuffer: Framebuffer,
    colour: Image,
    depth: Image,
    /// Readback buffer of the depths.
    depths: Buffer,
}

impl OffscreenView {
    /// Creates a view for frames of `presenter`; nothing is drawn yet.
    pub fn new(presenter: &Presenter, rasterizer: RasterizerChoice) -> Result<Self> {
        let device = presenter.device();
        presenter.rehearse()?;
        Ok(Self {
            scalar_colours: None,
            targets: None,
            target_renderer: TargetRenderer::new(device, presenter.format(), rasterizer)?,
            old: Vec::new(),
            timestamps: None,
            measured: false,
            drawn: None,
            stake: RefCell::default(),
            presenter: presenter.number(),
            rasterizer,
            device: device.clone(),
        })
    }

    /// Records a picture of `size` px over the settings' background; without a scene, the background alone. If `measured`, pass times and
    /// surfel counts are measured, unless an earlier measurement is not reported yet. After an error the picture is empty.
    ///
    /// # Errors
    /// As [`Renderer::prepare`]; [`Error::Usage`] in a frame of another presenter, or if it is drawn twice in one frame.
    pub fn draw(
        &mut self,
        frame: &Presented,
        size: [u32; 2],
        content: Option<SceneView<'_>>,
        measured: bool,
    ) -> Result<()> {
        self.check(frame)?;
        if self.drawn.replace(frame.number) == Some(frame.number) {
            return Err(Error::Usage(
                "an offscreen view is drawn twice in a frame: create one for each picture".into(),
            ));
        }
        self.forget_thrown();
        self.take_part(frame);
        // The GPU has finished all but the last frames.
        self.old.retain(|(last, _)| last + u64::from(FRAMES_IN_FLIGHT) > frame.number);
        let shading = content.map(|(.., settings)| settings.shading).filter(|shading| is_scalar(*shading));
        let format = if shading.is_some() { SCALARS } else { frame.format() };
        if self.target_renderer.format != format {
            let target_renderer = TargetRenderer::new(&self.device, format, self.rasterizer)?;
            self.defer(frame.number, true);
            let _target_renderer = Some(std::mem::replace(&mut self.target_renderer, target_renderer));
            self.old.push((frame.number, DeferredResources { _target_renderer, ..Default::default() }));
            self.measured = false;
        }
        if self.targets.as_ref().is_none_or(|targets| targets.colour.size() != size) {
            self.defer(frame.number, true);
            self.targets = Some(Targets::new(&self.device, &self.target_renderer, size)?);
        }
        if self.scalar_colours.as_ref().map(|scalar_colours| scalar_colours.shading) != shading {
            self.defer(frame.number, false);
            let picture = self.targets.as_ref().map(|targets| &targets.colour);
            let made = shading
                .zip(picture)
                .map(|(shading, of)| ScalarColours::new(&self.device, shading, of, frame.format()));
            match made.transpose() {
                Ok(made) => self.scalar_colours = made,
                Err(error) => {
                    // The targets may be new and are not drawn to.
                    self.defer(frame.number, true);
                    return Err(error);
                }
            }
        }
        self.record(frame, content, measured)
    }

    /// Defers the destruction of the scalar colours, and of the targets if `with_targets`, until frame `last` is over.
    fn defer(&mut self, last: u64, with_targets: bool) {
        let targets = if with_targets { self.targets.take() } else { None };
        let _scalar_colours = self.scalar_colours.take();
        self.old
            .push((last, DeferredResources { _scalar_colours, _targets: targets, _target_renderer: None }));
    }

    /// Whether there is no picture, not even a background.
    pub fn is_empty(&self) -> bool {
        self.targets.is_none() || self.is_thrown()
    }

    /// Whether the last frame that it recorded into was discarded.
    fn is_thrown(&self) -> bool {
        self.stake.borrow().as_ref().is_some_and(|(_, stake)| stake.is_thrown())
    }

    /// Defers the resources of a discarded frame.
    fn forget_thrown(&mut self) {
        if self.is_thrown() {
            let last = self.stake.take().map_or(0, |(last, _)| last);
            self.defer(last, true);
            self.measured = false;
        }
    }

    /// Takes a stake in `frame`.
    fn take_part(&self, frame: &Presented) {
        let mut stake = self.stake.borrow_mut();
        if stake.as_ref().is_none_or(|(number, _)| *number != frame.number) {
            *stake = Some((frame.number, frame.stake()));
        }
    }

    fn record(&mut self, frame: &Presented, content: Option<SceneView<'_>>, measured: bool) -> Result<()> {
        let Some(targets) = &self.targets else { return Ok(()) };
        let measured = content.is_some() && measured && !self.measured;
        let mut drawn = Ok(());
        if let Some((scene, camera, settings)) = content {
            let view = View::whole(*camera, targets.colour.size());
            self.target_renderer.renderer.measure(Measured { times: measured, counts: measured });
            // SAFETY: the presenter's command buffer is recording outside a render pass, and the presenter submits in order; `draw` runs
            // once per frame, so that the number of frames in flight is as stated.
            drawn = unsafe {
                self.target_renderer.renderer.prepare(frame.cmd, scene, &view, &before_background(settings))
            };
        }
        if measured && self.timestamps.is_none() {
            self.timestamps = Timestamps::new(&self.device)?;
        }
        self.measured |= measured;
        let timestamps = self.timestamps.as_mut().filter(|_| measured);
        // SAFETY: as above; the frame that was measured before is reported, so it is over.
        let mut rec = unsafe { Recorder::of_host_timed(&self.device, frame.cmd, timestamps) };
        let Targets { framebuffer, colour, depth, depths } = targets;
        let uses = [colour.with(Access::COLOUR_WRITE), depth.with(Access::DEPTH_WRITE)];
        let [r, g, b] = content.and_then(|(.., settings)| settings.background).unwrap_or_default();
        // Scalars get colours first, and the background after that.
        let behind = if self.scalar_colours.is_some() { [0.0; 4] } else { [r, g, b, 1.0] };
        let mut enc = rec.pass("screen", &uses);
        let draws = enc.render_over(framebuffer, behind);
        if content.is_some() && drawn.is_ok() {
            // SAFETY: inside the renderer's target.
            drawn = unsafe { self.target_renderer.renderer.draw(frame.cmd) };
        }
        drop(draws);
        drop(enc);
        let uses = [depth.with(Access::COPY_READ), depths.with(Access::COPY_WRITE)];
        rec.pass("depths", &uses).copy_image(depth, depths);
        let mut results = vec![depths.with(Access::HOST_READ)];
        match self.scalar_colours.as_ref().zip(content) {
            Some((scalar_colours, (.., settings))) => {
                scalar_colours.record(&mut rec, colour, settings);
                results.extend(scalar_colours.results());
            }
            None => results.push(colour.with(Access::COPY_READ)),
        }
        rec.wait(&results);
        drawn
    }

    /// Copies a range of columns of the picture, as fractions of its width, to the `area` px at the top left of the window, scaled. Depths,
    /// normals, overlaps and weights have the colours of a PNG.
    ///
    /// # Errors
    /// [`Error::Usage`] in a frame of another presenter.
    pub fn blit(&self, frame: &Presented, area: [u32; 2], columns: [f64; 2]) -> Result<()> {
        self.check(frame)?;
        let Some(Targets { colour, .. }) = self.targets.as_ref().filter(|_| !self.is_thrown()) else {
            return Ok(());
        };
        let image = self.scalar_colours.as_ref().map_or(colour, ScalarColours::image);
        self.take_part(frame);
        let uses = [image.with(Access::COPY_READ)];
        let mut rec = frame.recorder();
        rec.assume_layouts(&uses);
        rec.pass("show", &uses).copy_columns(image, frame, area, columns);
        Ok(())
    }

    /// Range of the depths, overlaps or weights of the last picture, if it shows these and a surface. Waits for the GPU.
    pub fn range(&self, presenter: &Presenter) -> Result<Option<ValueRange>> {
        self.wait(presenter)?;
        let scalar_colours = self.scalar_colours.as_ref().filter(|_| !self.is_thrown());
        Ok(scalar_colours.and_then(ScalarColours::range))
    }

    /// The report of the last measured picture, once. Waits for the GPU.
    pub fn report(&mut self, presenter: &Presenter) -> Result<Option<FrameReport>> {
        self.wait(presenter)?;
        self.forget_thrown();
        if !std::mem::take(&mut self.measured) {
            return Ok(None);
        }
        // SAFETY: every frame is over.
        unsafe { self.target_renderer.renderer.finish()? };
        let own = self.timestamps.as_ref().map_or(Ok(Vec::new()), Timestamps::read)?;
        let report = self.target_renderer.renderer.report().cloned();
        Ok(report.map(|mut report| {
            // `screen` includes it.
            report.pass_times.retain(|time| time.label != "composite");
            report.pass_times.extend(own);
            report
        }))
    }

    /// Width and height of the picture, px, and its reversed depths as of the camera's projection: a 4-byte float per pixel, row by row
    /// from the top left, 0 without a surface. Waits for the GPU.
    pub fn depths(&self, presenter: &Presenter) -> Result<Option<([u32; 2], &[u8])>> {
        self.wait(presenter)?;
        let targets = self.targets.as_ref().filter(|_| !self.is_thrown());
        Ok(targets.map(|targets| (targets.colour.size(), targets.depths.bytes())))
    }

    fn wait(&self, presenter: &Presenter) -> Result<()> {
        self.check_presenter(presenter.number())?;
        presenter.wait()
    }

    fn check(&self, frame: &Presented) -> Result<()> {
        self.check_presenter(frame.presenter)
    }

    fn check_presenter(&self, number: u64) -> Result<()> {
        if number == self.presenter {
            Ok(())
        } else {
            Err(Error::Usage("an offscreen view is used with another presenter: create one for each".into()))
        }
    }
}

impl Drop for OffscreenView {
    fn drop(&mut self) {
        if let Some((_, stake)) = self.stake.get_mut() {
            stake.go();
        }
        // A lost device has nothing left to wait for.
        let _ = self.device.wait_idle();
    }
}

impl TargetRenderer {
    fn new(device: &Arc<Device>, format: vk::Format, rasterizer: RasterizerChoice) -> Result<Self> {
        let pass = RenderPass::new(device, &[Attachment::Cleared(format)], Some(Attachment::Cleared(DEPTH)))?;
        let target = Target {
            pass: Pass::Subpass { pass: pass.handle(), subpass: 0 },
            colours: vec![format],
            depth: Some(DEPTH),
            stencil: vk::Format::UNDEFINED,
            reversed: true,
            write_depth: true,
            samples: vk::SampleCountFlags::TYPE_1,
            picture: 0,
            normal: None,
            id: None,
            encode: false,
        };
        let options = Options { frames_in_flight: FRAMES_IN_FLIGHT, rasterizer, ..Options::new(target) };
        // SAFETY: the target is this pass, which outlives the renderer; the view's `drop` waits for the GPU, and a replaced renderer is kept until
        // its frames are over.
        let renderer = unsafe { Renderer::new(device, options)? };
        Ok(Self { renderer, pass, format })
    }
}

impl Targets {
    fn new(device: &Arc<Device>, target_renderer: &TargetRenderer, size: [u32; 2]) -> Result<Self> {
        let TargetRenderer { pass, format, .. } = target_renderer;
        let colour = Image::target(device, "screen", *format, size, ImageUse::Output)?;
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

/// Settings of a picture that the view draws before the background itself.
fn before_background(settings: &Settings) -> Settings {
    Settings { alpha: settings.drawn_alpha(), ..settings.clone() }
}
