//! A picture of a scene in frames that go to a window: colours in linear float, and depth, of any size.

mod colour_map;
mod range;
mod scalar_colours;

use super::{Measured, Options, Pass, Renderer, Target, View};
use crate::error::{Error, Result};
use crate::frame::FrameReport;
use crate::geometry::{Camera, ValueRange};
use crate::scene::Scene;
use crate::settings::Settings;
use crate::settings::{Precision, Rasterizer};
use crate::vk::{
    Access, Attachment, Buffer, Device, FRAMES_IN_FLIGHT, Framebuffer, Image, ImageUse, Presented, Presenter,
    Recorder, RenderPass, Stake, Timestamps,
};
use ash::vk;
use scalar_colours::{ScalarColours, is_scalar};
use std::cell::RefCell;
use std::sync::Arc;

/// Formats of the targets.
const COLOUR: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const DEPTH: vk::Format = vk::Format::D32_SFLOAT;

/// A picture in frames of one [`Presenter`], which stays until it is drawn anew. What is unsafe of [`Renderer`] it sees to itself: it draws in
/// frames of that presenter alone, once in each, and is waited for before it goes; a frame that is being recorded meanwhile is not submitted.
pub struct OffscreenView {
    // Fields are dropped in this order: views before what they view, and the pass after all that draws in it.
    renderer: Renderer,
    /// The colours of a picture of numbers, where it is one.
    scalar_colours: Option<ScalarColours>,
    targets: Option<Targets>,
    /// What frames under way may use, each with the number of the last one that may.
    old: Vec<(u64, DeferredResources)>,
    timestamps: Option<Timestamps>,
    /// Whether a frame that is measured has not told yet.
    measured: bool,
    /// Number of the frame in which it was drawn last.
    drawn: Option<u64>,
    /// Its stake in the last frame that it recorded into, and the number of that.
    stake: RefCell<Option<(u64, Arc<Stake>)>>,
    /// Number of the presenter.
    presenter: u64,
    pass: RenderPass,
    device: Arc<Device>,
}

/// A scene, from where it is seen, and how.
pub type SceneView<'a> = (&'a Arc<Scene>, &'a Camera, &'a Settings);

/// What is not drawn to any more.
struct DeferredResources {
    // Views before what they view.
    _scalar_colours: Option<ScalarColours>,
    _targets: Option<Targets>,
}

struct Targets {
    framebuffer: Framebuffer,
    colour: Image,
    depth: Image,
    /// Where depths are read back.
    depths: Buffer,
}

impl OffscreenView {
    /// A picture in frames of `presenter`; nothing is drawn yet.
    pub fn new(presenter: &Presenter, rasterizer: Option<Rasterizer>) -> Result<Self> {
        let device = presenter.device();
        presenter.rehearse(COLOUR)?;
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
        // SAFETY: the target is this pass, which goes after the renderer; `drop` waits for the GPU.
        let renderer = unsafe { Renderer::new(device, options)? };
        Ok(Self {
            renderer,
            scalar_colours: None,
            targets: None,
            old: Vec::new(),
            timestamps: None,
            measured: false,
            drawn: None,
            stake: RefCell::default(),
            presenter: presenter.number(),
            pass,
            device: device.clone(),
        })
    }

    /// Records a picture of `size` px over the settings' background, or of that alone where nothing is shown. If it is `measured` it tells the GPU
    /// times of its passes and counts of surfels, unless another one has yet to tell. After an error it shows nothing.
    ///
    /// # Errors
    /// Those of [`Renderer::prepare`]; [`Error::Usage`] in a frame of another presenter, and a second time in one frame.
    pub fn draw(
        &mut self,
        frame: &Presented,
        size: [u32; 2],
        shown: Option<SceneView<'_>>,
        measured: bool,
    ) -> Result<()> {
        self.check(frame)?;
        if self.drawn.replace(frame.number) == Some(frame.number) {
            return Err(Error::Usage(
                "an offscreen view is drawn twice in a frame: make one for each picture".into(),
            ));
        }
        self.forget_thrown();
        self.take_part(frame);
        // The GPU is done with all but the last frames.
        self.old.retain(|(last, _)| last + u64::from(FRAMES_IN_FLIGHT) > frame.number);
        if self.targets.as_ref().is_none_or(|targets| targets.colour.size() != size) {
            self.defer(frame.number, true);
            self.targets = Some(Targets::new(&self.device, &self.pass, size)?);
        }
        let shading = shown.map(|(.., settings)| settings.shading).filter(|shading| is_scalar(*shading));
        if self.scalar_colours.as_ref().map(|scalar_colours| scalar_colours.shading) != shading {
            self.defer(frame.number, false);
            let picture = self.targets.as_ref().map(|targets| &targets.colour);
            let made =
                shading.zip(picture).map(|(shading, of)| ScalarColours::new(&self.device, shading, of));
            match made.transpose() {
                Ok(made) => self.scalar_colours = made,
                Err(error) => {
                    // Nothing is drawn to the targets, which may be new.
                    self.defer(frame.number, true);
                    return Err(error);
                }
            }
        }
        self.record(frame, shown, measured)
    }

    /// Keeps what frames up to this one may use, until they are over: the colours of numbers, and the targets if they go, too.
    fn defer(&mut self, last: u64, with_targets: bool) {
        let targets = if with_targets { self.targets.take() } else { None };
        let deferred = DeferredResources { _scalar_colours: self.scalar_colours.take(), _targets: targets };
        self.old.push((last, deferred));
    }

    /// Whether there is nothing to show, not even a background.
    pub fn is_empty(&self) -> bool {
        self.targets.is_none() || self.is_thrown()
    }

    /// Whether the last frame that it recorded into was thrown away.
    fn is_thrown(&self) -> bool {
        self.stake.borrow().as_ref().is_some_and(|(_, stake)| stake.is_thrown())
    }

    /// What was recorded into a frame that was thrown away is not there.
    fn forget_thrown(&mut self) {
        if self.is_thrown() {
            let last = self.stake.take().map_or(0, |(last, _)| last);
            self.defer(last, true);
            self.measured = false;
        }
    }

    /// Records into `frame` from now on.
    fn take_part(&self, frame: &Presented) {
        let mut stake = self.stake.borrow_mut();
        if stake.as_ref().is_none_or(|(number, _)| *number != frame.number) {
            *stake = Some((frame.number, frame.stake()));
        }
    }

    fn record(&mut self, frame: &Presented, shown: Option<SceneView<'_>>, measured: bool) -> Result<()> {
        let Some(targets) = &self.targets else { return Ok(()) };
        let measured = shown.is_some() && measured && !self.measured;
        let mut drawn = Ok(());
        if let Some((scene, camera, settings)) = shown {
            let view = View::whole(*camera, targets.colour.size());
            self.renderer.measure(Measured { times: measured, counts: measured });
            // SAFETY: the presenter's command buffer is being recorded, outside a render pass, and it submits in order; once a frame, so that as
            // many are under way as it says.
            drawn = unsafe { self.renderer.prepare(frame.cmd, scene, &view, settings) };
        }
        if measured && self.timestamps.is_none() {
            self.timestamps = Timestamps::new(&self.device)?;
        }
        self.measured |= measured;
        let timestamps = self.timestamps.as_mut().filter(|_| measured);
        // SAFETY: as above; what was measured before has told, so that it is over.
        let mut rec = unsafe { Recorder::of_host_timed(&self.device, frame.cmd, timestamps) };
        let Targets { framebuffer, colour, depth, depths } = targets;
        let uses = [colour.with(Access::COLOUR_WRITE), depth.with(Access::DEPTH_WRITE)];
        let [r, g, b] = shown.and_then(|(.., settings)| settings.background).unwrap_or_default();
        // ScalarColours become colours before there is something behind them.
        let behind = if self.scalar_colours.is_some() { [0.0; 4] } else { [r, g, b, 1.0] };
        let mut enc = rec.pass("screen", &uses);
        let draws = enc.render_over(framebuffer, behind);
        if shown.is_some() && drawn.is_ok() {
            // SAFETY: within the renderer's target.
            drawn = unsafe { self.renderer.draw(frame.cmd) };
        }
        drop(draws);
        drop(enc);
        let uses = [depth.with(Access::COPY_READ), depths.with(Access::COPY_WRITE)];
        rec.pass("depths", &uses).copy_image(depth, depths);
        let mut results = vec![depths.with(Access::HOST_READ)];
        match self.scalar_colours.as_ref().zip(shown) {
            Some((scalar_colours, (.., settings))) => {
                scalar_colours.record(&mut rec, colour, settings);
                results.extend(scalar_colours.results());
            }
            None => results.push(colour.with(Access::COPY_READ)),
        }
        rec.wait(&results);
        drawn
    }

    /// Shows the columns between two parts of the picture's width, from 0 to 1, in those of the `area` px of the window at its top left, scaled.
    /// Depths, normals, overlaps and weights are shown in the colours that a PNG has for them.
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
        rec.pass("show", &uses).blit_columns(image, frame, area, columns);
        Ok(())
    }

    /// The least and the greatest depth, overlap or weight of the last picture, if it is of such numbers and shows a surface. Waits for it.
    pub fn range(&self, presenter: &Presenter) -> Result<Option<ValueRange>> {
        self.wait(presenter)?;
        let scalar_colours = self.scalar_colours.as_ref().filter(|_| !self.is_thrown());
        Ok(scalar_colours.and_then(ScalarColours::range))
    }

    /// What the last picture that was measured tells, once; waits for it.
    pub fn report(&mut self, presenter: &Presenter) -> Result<Option<FrameReport>> {
        self.wait(presenter)?;
        self.forget_thrown();
        if !std::mem::take(&mut self.measured) {
            return Ok(None);
        }
        // SAFETY: every frame is over.
        unsafe { self.renderer.finish()? };
        let own = self.timestamps.as_ref().map_or(Ok(Vec::new()), Timestamps::read)?;
        let report = self.renderer.report().cloned();
        Ok(report.map(|mut report| {
            // It is within `screen`.
            report.pass_times.retain(|time| time.label != "composite");
            report.pass_times.extend(own);
            report
        }))
    }

    /// Width and height of the picture, px, and its depths as the camera's projection has them, reversed: a float of 4 bytes a pixel, row by row
    /// from the top left, 0 where nothing is. Waits for it.
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
            Err(Error::Usage("an offscreen view is used with another window than it was made for".into()))
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
