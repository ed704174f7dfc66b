//! Shading by depth: eye-dome lighting and ambient occlusion in the picture of a host, from its depth attachment.
//!
//! ```text
//! the host's depth ─ distance → distances ─ occlusion, ambient, edl → factors ─ darken → the host's colours
//! ```
//!
//! The passes `occlusion`, `ambient` and `edl` are those of other frames. They darken a white picture, by which the draw multiplies.

mod attachment;
mod conversion;
mod passes;
mod targets;

pub use attachment::DepthAttachment;

use super::deferred_destruction::DeferredDestruction;
use super::reports::{Measured, Reports};
use super::target::Target;
use super::view::View;
use crate::error::{Error, Result};
use crate::frame::FrameReport;
use crate::frame::uniforms::{self, Uniforms};
use crate::settings::Settings;
use crate::vk::shaders::layout::{Darken, Distance};
use crate::vk::shaders::{DARKEN_FRAGMENT, DARKEN_VERTEX, resource};
use crate::vk::{
    Access, Binding, Blend, Buffer, Code, Constants, DepthTest, DescriptorSet, Device, DrawPipeline, Draws,
    HostDepth, HostPass, Recorder, SetLayout, Update,
};
use ash::vk;
use passes::{Kind, Passes, depth_set};
use std::sync::Arc;
use targets::Targets;

/// Eye-dome lighting and ambient occlusion of a host's picture, from its depth attachment.
///
/// For frames with surfels in subpasses ([`native`](super::native)), which ignore both settings, or for any other picture. Surfels and meshes of
/// the host are darkened alike, by the depth that both have written. The factors are those by which [`Renderer`](crate::Renderer) darkens
/// a picture of the same distances. A picture that [`embed::Renderer`](super::Renderer) has drawn with these settings is dark already.
///
/// | the host | reads or writes |
/// |---|---|
/// | ends the pass that draws its depth | |
/// | makes its depth visible to `SHADER_READ` in `COMPUTE_SHADER`, in [`DepthAttachment::layout`] | |
/// | calls [`DepthShading::prepare`] outside a render pass | reads the depth |
/// | begins a pass of the [`Target`] that loads the colours | |
/// | calls [`DepthShading::draw`] | multiplies the colours; α stays |
/// | waits for `COMPUTE_SHADER` before it writes the depth again | |
///
/// Distances are as exact as the depth. Reversed `D32_SFLOAT` is best. Where the step between adjacent depths is not far below the width of a
/// pixel, as far away in 16 bits or without reversal, a surface has stripes.
///
/// ```no_run
/// use ash::vk;
/// use surfel::Settings;
/// use surfel::embed::{DepthShading, View};
///
/// // The settings are those of `native::Renderer::prepare`: with `Shading::Edl`, or with ambient occlusion.
/// unsafe fn shade(
///     host: &ash::Device,
///     shading: &mut DepthShading,
///     cmd: vk::CommandBuffer,
///     depth: vk::Image,
///     begin: &vk::RenderPassBeginInfo<'_>,
///     (view, settings): (&View, &Settings),
/// ) -> surfel::Result<()> {
///     let barrier = vk::ImageMemoryBarrier::default()
///         .src_access_mask(vk::AccessFlags::DEPTH_STENCIL_ATTACHMENT_WRITE)
///         .dst_access_mask(vk::AccessFlags::SHADER_READ)
///         .old_layout(vk::ImageLayout::DEPTH_STENCIL_ATTACHMENT_OPTIMAL)
///         .new_layout(vk::ImageLayout::DEPTH_STENCIL_READ_ONLY_OPTIMAL)
///         .image(depth)
///         .subresource_range(vk::ImageSubresourceRange {
///             // Of a format with a stencil both aspects, or the feature separateDepthStencilLayouts.
///             aspect_mask: vk::ImageAspectFlags::DEPTH,
///             level_count: 1,
///             layer_count: 1,
///             ..Default::default()
///         });
///     let drawn = vk::PipelineStageFlags::EARLY_FRAGMENT_TESTS | vk::PipelineStageFlags::LATE_FRAGMENT_TESTS;
///     let read = vk::PipelineStageFlags::COMPUTE_SHADER;
///     unsafe {
///         host.cmd_pipeline_barrier(cmd, drawn, read, vk::DependencyFlags::empty(), &[], &[], &[barrier]);
///         shading.prepare(cmd, view, settings)?;
///         host.cmd_begin_render_pass(cmd, begin, vk::SubpassContents::INLINE);
///         shading.draw(cmd)?;
///         host.cmd_end_render_pass(cmd);
///     }
///     Ok(())
/// }
/// ```
pub struct DepthShading {
    // Drop order: views before their resources.
    pending: Option<PreparedDraw>,
    reports: Reports,
    deferred: DeferredDestruction,
    targets: Option<Targets>,
    depth: Option<Depth>,
    view: DescriptorSet,
    uniforms: Buffer,
    passes: Vec<Passes>,
    darken: DrawPipeline,
    device: Arc<Device>,
}

/// The host's depth with its descriptor set.
struct Depth {
    attachment: DepthAttachment,
    set: DescriptorSet,
}

/// The prepared draw.
struct PreparedDraw {
    area: vk::Rect2D,
    /// `None` if nothing is darkened.
    pass: Option<HostPass>,
}

/// A frame: what its passes need.
struct Frame {
    kind: Kind,
    area: vk::Rect2D,
    uniforms: Uniforms,
    conversion: Distance,
}

impl DepthShading {
    /// Creates the draw in a pass of the host, which loads the colours at [`Target::picture`]: linear colours, premultiplied by α or opaque.
    /// [`Target::depth`] is that of the pass, if it has one; the draw neither tests nor writes it. `frames_in_flight` is as
    /// [`Options::frames_in_flight`](super::Options::frames_in_flight).
    ///
    /// Returns an error for an unsupported target: one with normals or ids, or with `encode`, because encoded colours cannot be multiplied.
    ///
    /// # Safety
    /// `target` describes the render pass correctly. The pass outlives this object, which is dropped only after the GPU has executed all that it
    /// recorded.
    pub unsafe fn new(device: &Arc<Device>, target: &Target, frames_in_flight: u32) -> Result<Self> {
        target.check(device)?;
        check_outputs(target)?;
        // SAFETY: by the caller.
        let within = unsafe { target.within(Blend::Multiply) };
        let fragment = Code::from(&DARKEN_FRAGMENT).at_locations([target.picture, 0, 0]);
        let code = [Code::from(&DARKEN_VERTEX), fragment];
        let layout = SetLayout::of(device, [&resource::PICTURE_IMAGE])?;
        let constants = Constants::default();
        let uniforms = Buffer::uniform(device, "frame", uniforms::BYTES)?;
        Ok(Self {
            pending: None,
            reports: Reports::new(frames_in_flight),
            deferred: DeferredDestruction::new(frames_in_flight)?,
            targets: None,
            depth: None,
            view: DescriptorSet::new(device, &uniforms::bindings(&uniforms))?,
            uniforms,
            passes: Vec::new(),
            darken: DrawPipeline::of_host(device, &[&layout], code, &constants, &within, DepthTest::None)?,
            device: device.clone(),
        })
    }

    /// Sets the host's depth attachment for the next frames. Call it again for another view, also if that has the handle of a destroyed one.
    /// After an error nothing has changed.
    ///
    /// # Safety
    /// `depth` describes the attachment correctly. Its view exists until the frames that are prepared before the next call are over.
    pub unsafe fn set_depth(&mut self, depth: &DepthAttachment) -> Result<()> {
        depth.check(&self.device)?;
        // SAFETY: by the caller.
        let view = unsafe { HostDepth::new(depth.view) };
        let set = depth_set(&self.device, depth.samples, Binding::SampledHostDepth(view, depth.layout))?;
        let old = self.depth.replace(Depth { attachment: *depth, set });
        self.deferred.defer(old.map(|old| old.set));
        Ok(())
    }

    /// Records the passes that compute the factors; [`DepthShading::draw`] then multiplies the host's colours in the viewport by them. `view` is
    /// that by which the depth was drawn, with [`Camera::reversed`](crate::geometry::Camera::reversed) as it is there, and `settings` are those of the picture: [`Shading::Edl`](crate::settings::Shading::Edl) with
    /// [`Settings::edl`], and [`Settings::ao`]. With neither, nothing is recorded, and the draw changes nothing. Pixels at the depth of the far
    /// plane, such as cleared ones, have no surface.
    ///
    /// After an error nothing is recorded, and there is nothing to draw.
    ///
    /// # Safety
    /// `cmd` is of the device and its queue family, is recording outside a render pass, and is submitted to the same queue as earlier
    /// commands, after them. The number of frames in flight is observed. The depth is in its layout, and visible to `SHADER_READ` in
    /// `COMPUTE_SHADER`; later writes wait for that stage.
    pub unsafe fn prepare(&mut self, cmd: vk::CommandBuffer, view: &View, settings: &Settings) -> Result<()> {
        self.pending = None;
        let frame = self.describe(view, settings)?;
        self.make(&frame)?;
        self.reports.begin(&self.device, &[], 0.0)?;
        self.deferred.advance();
        let Frame { kind, area, uniforms, conversion } = frame;
        let passes = self.passes.iter().find(|passes| passes.kind == kind);
        let (Some(passes), Some(targets), Some(depth)) = (passes, &self.targets, &self.depth) else {
            self.pending = Some(PreparedDraw { area, pass: None });
            return Ok(());
        };
        let (timestamps, tail) = self.reports.present();
        // SAFETY: by the caller; there is a report for each frame in flight.
        let mut rec = unsafe { Recorder::of_host_timed(&self.device, cmd, timestamps) };
        let bytes = uniforms.bytes();
        let update = Update { buffer: &self.uniforms, start: 0, bytes: &bytes, read: Access::UNIFORM_READ };
        rec.update([update].into_iter());
        passes.record(&mut rec, targets, [&self.view, &depth.set], &conversion);
        tail.record(&mut rec, &[]);
        rec.wait(&[targets.drawn()]);
        self.pending = Some(PreparedDraw { area, pass: Some(rec.later("darken")) });
        Ok(())
    }

    /// Records the draw. The host binds its state again as after [`Renderer::draw`](super::Renderer::draw).
    ///
    /// # Safety
    /// `cmd` is of the device and recording inside the subpass, or the dynamic rendering, of the target. The viewport of the prepared frame
    /// lies in the render area. The commands are submitted to the same queue after those that were prepared, and before those that prepare the
    /// next frame.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer) -> Result<()> {
        let Some(PreparedDraw { area, pass }) = &self.pending else {
            return Err(Error::Usage(
                "there is no shading to draw: prepare one, and handle its error".into(),
            ));
        };
        let (Some(pass), Some(targets)) = (pass, &self.targets) else { return Ok(()) };
        // SAFETY: by the caller.
        let mut draws = unsafe { Draws::of_host(&self.device, cmd, pass, *area) };
        let push = Darken { origin: [area.offset.x, area.offset.y] };
        draws.draw(&self.darken, &[&targets.picture], &push, 3);
        Ok(())
    }

    /// Creates the pipelines of frames like this one, for the depth that was set; see
    /// [`embed::Renderer::make_pipelines`](super::Renderer::make_pipelines).
    pub fn make_pipelines(&mut self, view: &View, settings: &Settings) -> Result<()> {
        let Frame { kind, .. } = self.describe(view, settings)?;
        self.make_passes(kind)
    }

    /// See [`embed::Renderer::measure`](super::Renderer::measure). There are no counts.
    pub fn measure(&mut self, measured: Measured) {
        self.reports.measure(measured);
    }

    /// See [`embed::Renderer::report`](super::Renderer::report). The last pass, `darken`, is inside the host's pass.
    pub fn report(&self) -> Option<&FrameReport> {
        self.reports.last()
    }

    /// See [`embed::Renderer::finish`](super::Renderer::finish).
    ///
    /// # Safety
    /// The GPU has finished every frame that was prepared without an error.
    pub unsafe fn finish(&mut self) -> Result<()> {
        self.reports.finish()
    }

    /// Describes a frame; rejects unsupported ones.
    fn describe(&self, view: &View, settings: &Settings) -> Result<Frame> {
        let Some(Depth { attachment, .. }) = &self.depth else {
            return Err(Error::Usage("there is no depth attachment: call `set_depth` before".into()));
        };
        settings.check()?;
        let target_view = view.in_target(&self.device, None)?;
        target_view.check_area("depth has", attachment.size, "set_depth")?;
        let conversion = conversion::conversion(view, &target_view, attachment)?;
        let settings = Settings { background: None, ..settings.clone() };
        let uniforms = Uniforms::new(&target_view.camera, &settings, target_view.size, &[])?;
        let perspective = target_view.camera.projection()?.perspective;
        let kind = Kind::new(perspective, attachment.samples, &settings);
        Ok(Frame { kind, area: target_view.area, uniforms, conversion })
    }

    /// Creates missing resources of a frame.
    fn make(&mut self, frame: &Frame) -> Result<()> {
        let vk::Extent2D { width, height } = frame.area.extent;
        let (size, Kind { ao, .. }) = ([width, height], frame.kind);
        self.make_passes(frame.kind)?;
        if frame.kind.darkens() && !self.targets.as_ref().is_some_and(|targets| targets.fits(size, ao)) {
            let old = self.targets.replace(Targets::new(&self.device, size, ao)?);
            self.deferred.defer(old);
        }
        Ok(())
    }

    fn make_passes(&mut self, kind: Kind) -> Result<()> {
        if kind.darkens() && self.passes.iter().all(|passes| passes.kind != kind) {
            self.passes.push(Passes::new(&self.device, kind)?);
        }
        Ok(())
    }
}

/// Returns an error if the target has more than colours.
fn check_outputs(target: &Target) -> Result<()> {
    let refuse = |cause: &str| Err(Error::Usage(format!("the host's target is not supported: {cause}")));
    if target.normal.is_some() || target.id.is_some() {
        return refuse("shading by depth changes colours only: leave `normal` and `id` out");
    }
    if target.encode {
        return refuse(
            "encoded colours cannot be multiplied: leave `encode` out, and draw to a view of an sRGB format",
        );
    }
    Ok(())
}
