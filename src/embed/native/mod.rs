//! Surfels in subpasses of the host's render pass: visibility, sums and picture stay in tile memory, without an intermediate picture.
//!
//! ```text
//! once          HostRenderPass ─ Plan::new → what to append to the render pass ─ the host makes it ─ Renderer::new
//! each size     Renderer::resize → the views that follow in the framebuffer
//! each frame    Renderer::prepare: footprints, outside the render pass
//!               the host's subpasses ─ Renderer::draw: seed, visibility, attribute, normalize ─ the host's subpasses
//! ```
//!
//! `draw` advances from subpass to subpass: from the host's last one before to the engine's last one, in which the host may draw, too.
//!
//! Eye-dome lighting and ambient occlusion read neighbours: [`DepthShading`](super::DepthShading) adds them after the render pass.
//!
//! Supports the methods that draw splats. Methods that blend have the subpasses visibility, attribute and normalize; methods that show the
//! nearest splat have nearest and normalize. The picture equals that of [`embed::Renderer`](super::Renderer) with
//! [`Rasterizer::Draw`](crate::Rasterizer::Draw), bit for bit. With [`Depth::seed`], a seed subpass comes first: it moves the host's depth
//! back by several ε, and splats behind it are rejected. This may make a difference at edge-on discs.
//!
//! ```no_run
//! use ash::vk;
//! use std::sync::Arc;
//! use surfel::embed::{View, native};
//! use surfel::vk::Device;
//! use surfel::{Precision, Scene, Settings};
//!
//! // Once. The host has attachments 0 (colour) and 1 (depth), a subpass for its meshes, and one for its glass.
//! unsafe fn make(
//!     host: &ash::Device,
//!     device: &Arc<Device>,
//!     scene: &Scene,
//!     mut attachments: Vec<vk::AttachmentDescription>,
//!     [meshes, glass]: [vk::SubpassDescription<'_>; 2],
//!     mut dependencies: Vec<vk::SubpassDependency>,
//! ) -> surfel::Result<native::Renderer> {
//!     let host_pass = native::HostRenderPass {
//!         attachments: &attachments,
//!         subpasses: [1, 1],
//!         picture: 0,
//!         resolve: None,
//!         normal: None,
//!         depth: Some(native::Depth { attachment: 1, reversed: true, seed: true }),
//!         encode: false,
//!     };
//!     let plan = native::Plan::new(device, &host_pass, Precision::Full, &[(scene.streams(), &Settings::default())])?;
//!     attachments.extend(plan.attachments());
//!     dependencies.extend(plan.dependencies());
//!     let subpasses: Vec<_> = [meshes].into_iter().chain(plan.subpasses()).chain([glass]).collect();
//!     let info = vk::RenderPassCreateInfo::default().attachments(&attachments).subpasses(&subpasses).dependencies(&dependencies);
//!     let pass = unsafe { host.create_render_pass(&info, None) }.map_err(surfel::Error::vulkan("vkCreateRenderPass"))?;
//!     unsafe { native::Renderer::new(device, plan, pass, 2) }
//! }
//!
//! // Each size. `depth` is a view of the depth aspect only.
//! unsafe fn resize(renderer: &mut native::Renderer, size: [u32; 2], [colour, depth]: [vk::ImageView; 2]) -> surfel::Result<Vec<vk::ImageView>> {
//!     Ok([colour, depth].into_iter().chain(unsafe { renderer.resize(size, Some(depth))? }).collect())
//! }
//!
//! // Each frame. The engine's clear values follow the host's, too: `Plan::clear_values`.
//! unsafe fn frame(
//!     host: &ash::Device,
//!     renderer: &mut native::Renderer,
//!     cmd: vk::CommandBuffer,
//!     begin: &vk::RenderPassBeginInfo<'_>,
//!     scene: &Arc<Scene>,
//!     view: &View,
//! ) -> surfel::Result<()> {
//!     unsafe {
//!         renderer.prepare(cmd, scene, view, &Settings::default())?;
//!         host.cmd_begin_render_pass(cmd, begin, vk::SubpassContents::INLINE);
//!         // The host draws its meshes.
//!         renderer.draw(cmd)?;
//!         host.cmd_next_subpass(cmd, vk::SubpassContents::INLINE);
//!         // The host draws its glass.
//!         host.cmd_end_render_pass(cmd);
//!     }
//!     Ok(())
//! }
//! ```

mod dependencies;
mod host_pass;
mod plan;
mod seeding;
mod subpasses;
mod targets;

pub use host_pass::{Depth, HostRenderPass};
pub use plan::Plan;

use super::View;
use super::deferred_destruction::DeferredDestruction;
use super::reports::{Measured, Reports};
use super::view::TargetView;
use crate::error::{Error, Result};
use crate::frame::FrameReport;
use crate::frame::description::Description;
use crate::frame::resources::{Disposal, FrameResources};
use crate::frame::scene_variant::SceneVariant;
use crate::frame::targets::check_size;
use crate::frame::uniforms::Uniforms;
use crate::scene::instance::Instances;
use crate::settings::Settings;
use crate::settings::splatting::Visibility;
use crate::vk::shaders::layout;
use crate::vk::{Device, Draws, HostDepth, HostPass, Recorder};
use ash::vk;
use plan::{Step, check_method};
use std::sync::Arc;
use targets::Targets;

/// Renders scenes in subpasses of a host.
pub struct Renderer {
    // Drop order: views before their resources.
    pending: Option<PreparedFrame>,
    frame: FrameResources,
    reports: Reports,
    deferred: DeferredDestruction,
    targets: Option<Arc<Targets>>,
    plan: Plan,
    device: Arc<Device>,
}

/// The prepared frame.
struct PreparedFrame {
    push: PushConstants,
    area: vk::Rect2D,
    /// The passes of the subpasses, in order.
    passes: Vec<HostPass>,
}

/// Push constants of a frame.
#[derive(Clone, Copy)]
struct PushConstants {
    /// Parameters of the seed; `None` if it is not drawn.
    seed: Option<layout::Seed>,
    host: layout::Subpass,
}

/// Whether splats behind a surface by more than the reach of ε are invisible. They are not if discs are moved before projection, which may
/// move them in any direction at a pixel, or if anything beyond clip lines counts as behind everything.
fn can_seed(variant: &SceneVariant) -> bool {
    !(variant.frame.visibility == Visibility::Axis || variant.frame.coverage && variant.clips)
}

impl Renderer {
    /// Creates a renderer in a render pass of the host, without scene resources. `frames_in_flight` is as
    /// [`Options::frames_in_flight`](super::Options::frames_in_flight).
    ///
    /// # Safety
    /// `pass` is of the device, has the host's attachments, subpasses and dependencies as the plan's [`HostRenderPass`] describes them,
    /// with the plan's additions in place. It outlives the renderer, which is dropped only after the GPU has executed all that it recorded.
    pub unsafe fn new(
        device: &Arc<Device>,
        plan: Plan,
        pass: vk::RenderPass,
        frames_in_flight: u32,
    ) -> Result<Self> {
        if pass == vk::RenderPass::null() {
            return Err(Error::Usage(
                "there is no render pass: create one of the host's parts and the plan's".into(),
            ));
        }
        // SAFETY: by the caller.
        let host = unsafe { subpasses::host(&plan, pass) };
        let options = plan.options([1, 1]);
        Ok(Self {
            pending: None,
            frame: FrameResources::new(device, options, Disposal::Deferred(Vec::new()), Some(host))?,
            deferred: DeferredDestruction::new(frames_in_flight)?,
            reports: Reports::new(frames_in_flight),
            targets: None,
            plan,
            device: device.clone(),
        })
    }

    /// The plan of the render pass.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Creates the engine's attachments of `size` px, the size of the framebuffer, and returns their views, which follow the host's in the
    /// framebuffer. `depth` is the host's, for [`Depth::seed`]. Call it again for another size, or for another depth, at most once before
    /// the next frame. After an error nothing has changed.
    ///
    /// The views exist until all frames in flight after the next call are prepared, or the renderer is dropped.
    ///
    /// # Safety
    /// `depth` is a view of the depth aspect only of the depth attachment's image, in every framebuffer with these views. It exists until
    /// the frames that are prepared before the next call are over.
    pub unsafe fn resize(
        &mut self,
        size: [u32; 2],
        depth: Option<vk::ImageView>,
    ) -> Result<Vec<vk::ImageView>> {
        check_size(&self.device, size)?;
        let seeded = self.plan.seeded().is_some();
        if seeded && depth.is_none_or(|depth| depth == vk::ImageView::null()) {
            return Err(Error::Usage(
                "a seed needs a view of the host's depth: give one, or create the plan without `seed`".into(),
            ));
        }
        // SAFETY: by the caller.
        let depth = depth.filter(|_| seeded).map(|depth| unsafe { HostDepth::new(depth) });
        let targets = match &self.targets {
            Some(targets) if targets.size == size => targets.beside(depth),
            _ => Targets::new(&self.device, &self.plan, size, depth)?,
        };
        let views = targets.views();
        self.pending = None;
        self.frame.discard_targets();
        self.deferred.extend(self.frame.take_deferred());
        let old = self.targets.replace(Arc::new(targets));
        self.deferred.defer(old);
        Ok(views)
    }

    /// Records the passes of a frame that come before the render pass; [`Renderer::draw`] records the others. The picture has the size of
    /// the viewport; pixels without a surface are transparent, whatever `settings.background` is.
    ///
    /// After an error nothing is recorded, and there is no frame to draw.
    ///
    /// # Safety
    /// `cmd` is of the device and its queue family, is recording outside a render pass, and is submitted to the same queue as earlier
    /// commands, after them. The number of frames in flight is observed.
    pub unsafe fn prepare<'a>(
        &mut self,
        cmd: vk::CommandBuffer,
        scenes: impl Into<Instances<'a>>,
        view: &View,
        settings: &Settings,
    ) -> Result<()> {
        self.pending = None;
        let made = self.make(scenes.into(), view, settings);
        // Also after an error: replaced resources may be in use.
        self.deferred.extend(self.frame.take_deferred());
        let (uniforms, push, area) = made?;
        let scenes: Vec<_> = self.frame.scenes().collect();
        self.reports.begin(&self.device, &scenes, self.frame.lod())?;
        self.deferred.advance();
        let (timestamps, tail) = self.reports.present();
        // SAFETY: by the caller; there is a report for each frame in flight.
        let mut rec = unsafe { Recorder::of_host_timed(&self.device, cmd, timestamps) };
        self.frame.record(&mut rec, &uniforms);
        tail.record(&mut rec, &scenes);
        let passes = self.plan.numbered().map(|(_, step)| rec.later(step.pass().name)).collect();
        self.pending = Some(PreparedFrame { push, area, passes });
        Ok(())
    }

    /// Records the subpasses and advances between them: afterwards the command buffer is in the last one, [`Plan::last`]. The host binds its
    /// state again as after [`embed::Renderer::draw`](super::Renderer::draw).
    ///
    /// After an error nothing is recorded: call [`Renderer::skip`] to advance.
    ///
    /// # Safety
    /// `cmd` is of the device and recording inside the render pass, with a framebuffer of the views that were returned last, in the subpass
    /// before the plan's first, or in that one if it is the first. The viewport of the prepared frame lies in the render area. The commands
    /// are submitted to the same queue after those that prepared the frame, and before those that prepare the next one.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer) -> Result<()> {
        // SAFETY: by the caller.
        unsafe {
            self.draw_each(|subpass| {
                self.enter(cmd, subpass);
                cmd
            })
        }
    }

    /// Enters a subpass from the one before.
    unsafe fn enter(&self, cmd: vk::CommandBuffer, subpass: u32) {
        // Beginning the render pass enters the first one.
        if subpass > 0 {
            // SAFETY: by the caller.
            unsafe { Draws::next_subpass(&self.device, cmd) };
        }
    }

    /// Like [`Renderer::draw`], for hosts that advance between subpasses themselves, or record each into its own command buffer: `next` is
    /// called before each subpass with its index, and returns the command buffer.
    ///
    /// # Safety
    /// As for [`Renderer::draw`], for the subpass of which `next` is called.
    pub unsafe fn draw_each(&self, mut next: impl FnMut(u32) -> vk::CommandBuffer) -> Result<()> {
        let (Some(PreparedFrame { push, area, passes }), Some((current, frame))) =
            (&self.pending, self.frame.frame())
        else {
            return Err(Error::Usage("there is no frame to draw: prepare one, and handle its error".into()));
        };
        for ((subpass, step), pass) in self.plan.numbered().zip(passes) {
            let cmd = next(subpass);
            // SAFETY: by the caller.
            let mut draws = unsafe { Draws::of_host(&self.device, cmd, pass, *area) };
            let Some(prepared) = current.pass(step.pass()) else { continue };
            match (step, &push.seed) {
                (Step::Seed, Some(seed)) => prepared.draw(&mut draws, &frame, seed),
                (Step::Seed, None) => {}
                (Step::Normalize, _) => prepared.draw(&mut draws, &frame, &push.host),
                (Step::Visibility | Step::Attribute | Step::Nearest, _) => {
                    prepared.draw(&mut draws, &frame, &());
                }
            }
        }
        Ok(())
    }

    /// Advances through the subpasses without drawing, as for a frame that could not be prepared.
    ///
    /// # Safety
    /// As that of [`Renderer::draw`].
    pub unsafe fn skip(&self, cmd: vk::CommandBuffer) {
        for (subpass, _) in self.plan.numbered() {
            // SAFETY: by the caller.
            unsafe { self.enter(cmd, subpass) };
        }
    }

    /// See [`embed::Renderer::make_pipelines`](super::Renderer::make_pipelines).
    pub fn make_pipelines<'a>(
        &mut self,
        scenes: impl Into<Instances<'a>>,
        view: &View,
        settings: &Settings,
    ) -> Result<()> {
        let placed = scenes.into().placed(&self.device)?;
        let TargetView { size, camera, .. } = view.in_target(&self.device, self.plan.host.reversed)?;
        let settings = settings.in_subpasses();
        check_method(&settings)?;
        let frame = self.frame.describe(&placed, &camera, &settings, size)?;
        self.plan.check(&frame.variant)?;
        self.frame.make_pipelines(&frame)
    }

    /// See [`embed::Renderer::measure`](super::Renderer::measure).
    pub fn measure(&mut self, measured: Measured) {
        self.reports.measure(measured);
        self.frame.count(measured.counts);
    }

    /// See [`embed::Renderer::report`](super::Renderer::report). The time of a subpass runs from the end of the work before it to the end
    /// of its own. On a tile-based GPU subpasses overlap: only their sum is meaningful.
    pub fn report(&self) -> Option<&FrameReport> {
        self.reports.last()
    }

    /// See [`embed::Renderer::finish`](super::Renderer::finish). The last frame cannot be drawn again.
    ///
    /// # Safety
    /// The GPU has finished every frame that was prepared without an error.
    pub unsafe fn finish(&mut self) -> Result<()> {
        self.pending = None;
        drop(self.frame.take_deferred());
        self.deferred.finish();
        self.reports.finish()
    }

    /// Creates the resources of a frame: its uniforms, push constants and area.
    fn make(
        &mut self,
        scenes: Instances<'_>,
        view: &View,
        settings: &Settings,
    ) -> Result<(Uniforms, PushConstants, vk::Rect2D)> {
        let placed = scenes.placed(&self.device)?;
        let target_view = view.in_target(&self.device, self.plan.host.reversed)?;
        let targets = self.targets_of(&target_view)?;
        let TargetView { area, size, camera, depth, .. } = target_view;
        let settings = settings.in_subpasses();
        check_method(&settings)?;
        let mut frame = self.frame.describe(&placed, &camera, &settings, size)?;
        self.plan.check(&frame.variant)?;
        let origin = [area.offset.x as f32, area.offset.y as f32];
        frame.uniforms.frame.origin = origin;
        let Description { uniforms, variant, scenes: own, .. } = &frame;
        let format = self.plan.seeded().filter(|_| own.iter().all(can_seed));
        let largest = placed.iter().map(|placed| placed.largest()).reduce(|a, b| Some(a?.max(b?))).flatten();
        let seed = format.zip(largest).and_then(|(format, largest)| {
            seeding::seed(
                format,
                depth,
                (&uniforms.frame, uniforms.view.distance_offset.into(), variant.perspective),
                largest,
                variant.precision,
            )
        });
        let bindings = targets.bindings(&subpasses::inputs(&self.plan));
        self.frame.make(&placed, &frame, targets.size, &bindings)?;
        self.deferred.keep_scenes(&scenes);
        Ok((frame.uniforms, PushConstants { seed, host: layout::Subpass { depth } }, area))
    }

    /// The attachments, if the view is within them.
    fn targets_of(&self, view: &TargetView) -> Result<Arc<Targets>> {
        let Some(targets) = &self.targets else {
            return Err(Error::Usage("there are no attachments: call `resize` before `prepare`".into()));
        };
        view.check_area("attachments have", targets.size, "resize")?;
        Ok(targets.clone())
    }
}
