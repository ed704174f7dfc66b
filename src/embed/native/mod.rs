//! Surfels in subpasses of a host's own render pass: visibility, sums and picture stay on the tile, and no picture is drawn elsewhere first.
//!
//! ```text
//! once          HostRenderPass ─ Plan::new → what to append to the render pass ─ the host makes it ─ Renderer::new
//! each size     Renderer::resize → the views that follow in the framebuffer
//! each frame    Renderer::prepare: footprints, outside the render pass
//!               the host's subpasses ─ Renderer::draw: seed, visibility, attribute, normalize ─ the host's subpasses
//! ```
//!
//! `draw` goes from subpass to subpass itself: from the host's last one before into surfel's last, in which the host may draw, too.
//!
//! For the methods that draw splats; those that blend have the subpasses visibility, attribute and normalize, those that show the nearest
//! alone nearest and normalize. The picture is that of [`embed::Renderer`](super::Renderer) by
//! [`Rasterizer::Draw`](crate::Rasterizer::Draw), bit for bit. The seed comes first where
//! [`Depth::seed`] asks for it: the host's depth, moved back by several ε, is what splats have to be in front of; it may make a difference at
//! discs that are seen edge-on.
//!
//! ```no_run
//! use ash::vk;
//! use std::sync::Arc;
//! use surfel::embed::{View, native};
//! use surfel::vk::Device;
//! use surfel::{Precision, Scene, Settings};
//!
//! /// Once. The host has attachments 0 (colour) and 1 (depth), a subpass that draws its meshes, and one that draws its glass.
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
//! /// Each size. `depth` sees the depth aspect alone.
//! unsafe fn resize(renderer: &mut native::Renderer, size: [u32; 2], [colour, depth]: [vk::ImageView; 2]) -> surfel::Result<Vec<vk::ImageView>> {
//!     Ok([colour, depth].into_iter().chain(unsafe { renderer.resize(size, Some(depth))? }).collect())
//! }
//!
//! /// Each frame. Clear values follow the host's, too: `Plan::clear_values`.
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

use super::deferred_destruction::DeferredDestruction;
use super::reports::{Measured, Reports};
use super::view::TargetView;
use super::{View, without_background};
use crate::error::{Error, Result};
use crate::frame::FrameReport;
use crate::frame::description::Description;
use crate::frame::resources::{FrameResources, Retired};
use crate::frame::targets::check_size;
use crate::frame::uniforms::Blocks;
use crate::frame::variant::SceneVariant;
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
    // Fields are dropped in this order: views before what they view.
    shown: Option<PreparedFrame>,
    frame: FrameResources,
    reports: Reports,
    deferred: DeferredDestruction,
    targets: Option<Arc<Targets>>,
    plan: Plan,
    device: Arc<Device>,
}

/// The frame that is prepared.
struct PreparedFrame {
    push: PushConstants,
    area: vk::Rect2D,
    /// Of the subpasses, in their order.
    passes: Vec<HostPass>,
}

/// The numbers of a frame that are pushed.
#[derive(Clone, Copy)]
struct PushConstants {
    /// What splats start from; nothing if the seed is not drawn.
    seed: Option<layout::Seed>,
    host: layout::Subpass,
}

/// Whether what is hidden behind a surface, and more than the reach of ε, cannot be seen: not if discs are moved before they are projected,
/// which at a pixel may move them any way, or if what is beyond clip lines counts as behind everything.
fn can_seed(variant: &SceneVariant) -> bool {
    !(variant.frame.visibility == Visibility::Axis || variant.frame.coverage && variant.clips)
}

impl Renderer {
    /// A renderer in a render pass of the host, which has made nothing for any scene yet. As many frames may be under way as
    /// [`Options::frames_in_flight`](super::Options::frames_in_flight) says.
    ///
    /// # Safety
    /// `pass` is of the device, has the host's attachments, subpasses and dependencies as the plan's [`HostRenderPass`] says, what the plan adds in its
    /// host_pass, and outlives the renderer, which is dropped only when the GPU is done with all that it recorded.
    pub unsafe fn new(
        device: &Arc<Device>,
        plan: Plan,
        pass: vk::RenderPass,
        frames_in_flight: u32,
    ) -> Result<Self> {
        if pass == vk::RenderPass::null() {
            return Err(Error::Usage(
                "no render pass: make one of the host's parts and of what the plan adds".into(),
            ));
        }
        // SAFETY: by the caller.
        let host = unsafe { subpasses::host(&plan, pass) };
        let options = plan.options([1, 1]);
        Ok(Self {
            shown: None,
            frame: FrameResources::new(device, options, Retired::Kept(Vec::new()), Some(host))?,
            deferred: DeferredDestruction::new(frames_in_flight)?,
            reports: Reports::new(frames_in_flight),
            targets: None,
            plan,
            device: device.clone(),
        })
    }

    /// What it adds to the render pass.
    pub fn plan(&self) -> &Plan {
        &self.plan
    }

    /// Makes attachments of `size` px, that of the framebuffer, and gives their views, which follow the host's in it. `depth` is the host's, where
    /// [`Depth::seed`] asks for it. To be called again for another size, and for another depth, once before the
    /// next frame: what was made is kept until frames come. After an error all is as it was.
    ///
    /// The views are there until as many frames as may be under way have been prepared after the next call, or the renderer is dropped.
    ///
    /// # Safety
    /// `depth` is a view of the depth aspect alone of the image that is the depth attachment of every framebuffer with these views. It is there until
    /// the frames are over that are prepared before the next call.
    pub unsafe fn resize(
        &mut self,
        size: [u32; 2],
        depth: Option<vk::ImageView>,
    ) -> Result<Vec<vk::ImageView>> {
        check_size(&self.device, size)?;
        let seeded = self.plan.seeded().is_some();
        if seeded && depth.is_none_or(|depth| depth == vk::ImageView::null()) {
            return Err(Error::Usage(
                "splats are to start from the host's depth, and there is no view of it: give one, or make the plan without `seed`".into(),
            ));
        }
        // SAFETY: by the caller.
        let depth = depth.filter(|_| seeded).map(|depth| unsafe { HostDepth::new(depth) });
        let targets = match &self.targets {
            Some(targets) if targets.size == size => targets.beside(depth),
            _ => Targets::new(&self.device, &self.plan, size, depth)?,
        };
        let views = targets.views();
        self.shown = None;
        self.frame.forget_targets();
        self.deferred.extend(self.frame.take_deferred());
        let old = self.targets.replace(Arc::new(targets));
        self.deferred.defer(old);
        Ok(views)
    }

    /// Records what a frame of a scene, or of several where they are placed, needs before the render pass, of which [`Renderer::draw`] records
    /// the rest. The picture has the viewport's size; what has none of the scenes is transparent, whatever `settings.background` says.
    ///
    /// After an error nothing is recorded, and nothing is there to draw.
    ///
    /// # Safety
    /// `cmd` is of the device, of the queue family that it was lent with, is being recorded outside a render pass, and is submitted to the
    /// same queue as what was recorded before, after it. What was said of frames in flight is true.
    pub unsafe fn prepare<'a>(
        &mut self,
        cmd: vk::CommandBuffer,
        scenes: impl Into<Instances<'a>>,
        view: &View,
        settings: &Settings,
    ) -> Result<()> {
        self.shown = None;
        let made = self.make(scenes.into(), view, settings);
        // Also after an error: what it took the place of may be under way.
        self.deferred.extend(self.frame.take_deferred());
        let (blocks, push, area) = made?;
        let scenes: Vec<_> = self.frame.scenes().collect();
        self.reports.begin(&self.device, &scenes)?;
        self.deferred.advance();
        let (timestamps, tail) = self.reports.present();
        // SAFETY: by the caller; the reports have one for each frame under way.
        let mut rec = unsafe { Recorder::of_host_timed(&self.device, cmd, timestamps) };
        self.frame.record(&mut rec, &blocks);
        tail.record(&mut rec, &scenes);
        let passes = self.plan.numbered().map(|(_, step)| rec.later(step.pass().name)).collect();
        self.shown = Some(PreparedFrame { push, area, passes });
        Ok(())
    }

    /// Records the subpasses, going from each to the next: the command buffer then is in the last one, [`Plan::last`]. Sets viewport and
    /// scissor, and binds pipelines and descriptor sets 0 and 1.
    ///
    /// After an error nothing is recorded: [`Renderer::skip`] goes on all the same.
    ///
    /// # Safety
    /// `cmd` is of the device, and is being recorded inside an instance of the render pass, with a framebuffer of the views that were given last, in
    /// the subpass before the plan's first, or in that if none is before it. It is submitted after what prepared the frame, to the same queue, and
    /// before what prepares the next one.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer) -> Result<()> {
        // SAFETY: by the caller.
        unsafe {
            self.draw_each(|subpass| {
                self.enter(cmd, subpass);
                cmd
            })
        }
    }

    /// Goes on to a subpass from the one before.
    unsafe fn enter(&self, cmd: vk::CommandBuffer, subpass: u32) {
        // The first one is entered where the render pass begins.
        if subpass > 0 {
            // SAFETY: by the caller.
            unsafe { Draws::next_subpass(&self.device, cmd) };
        }
    }

    /// As [`Renderer::draw`], for hosts that go from subpass to subpass themselves, or record each into a command buffer of its own: `next` is
    /// called before each subpass, with its number, and gives what it is recorded to.
    ///
    /// # Safety
    /// As that of [`Renderer::draw`], of the subpass for which `next` is called.
    pub unsafe fn draw_each(&self, mut next: impl FnMut(u32) -> vk::CommandBuffer) -> Result<()> {
        let (Some(PreparedFrame { push, area, passes }), Some((present, frame))) =
            (&self.shown, self.frame.frame())
        else {
            return Err(Error::Usage("there is no frame to draw: prepare one, and heed its error".into()));
        };
        for ((subpass, step), pass) in self.plan.numbered().zip(passes) {
            let cmd = next(subpass);
            // SAFETY: by the caller.
            let mut draws = unsafe { Draws::of_host(&self.device, cmd, pass, *area) };
            let Some(prepared) = present.pass(step.pass()) else { continue };
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

    /// Goes through the subpasses and draws nothing, as in a frame that could not be prepared.
    ///
    /// # Safety
    /// As that of [`Renderer::draw`].
    pub unsafe fn skip(&self, cmd: vk::CommandBuffer) {
        for (subpass, _) in self.plan.numbered() {
            // SAFETY: by the caller.
            unsafe { self.enter(cmd, subpass) };
        }
    }

    /// As [`embed::Renderer::make_pipelines`](super::Renderer::make_pipelines).
    pub fn make_pipelines<'a>(
        &mut self,
        scenes: impl Into<Instances<'a>>,
        view: &View,
        settings: &Settings,
    ) -> Result<()> {
        let placed = scenes.into().placed(&self.device)?;
        let TargetView { size, camera, .. } = view.in_target(&self.device, self.plan.host.reversed)?;
        let settings = without_background(settings);
        check_method(&settings)?;
        let frame = self.frame.describe(&placed, &camera, &settings, size)?;
        self.plan.check(&frame.variant)?;
        self.frame.make_pipelines(&frame)
    }

    /// As [`embed::Renderer::measure`](super::Renderer::measure).
    pub fn measure(&mut self, measured: Measured) {
        self.reports.measure(measured);
        self.frame.count(measured.counts);
    }

    /// As [`embed::Renderer::report`](super::Renderer::report). A subpass takes from when the work before it is done to when its own is; on a GPU
    /// that draws tile by tile, whose subpasses overlap, only the sum of them says something.
    pub fn report(&self) -> Option<&FrameReport> {
        self.reports.last()
    }

    /// As [`embed::Renderer::finish`](super::Renderer::finish).
    ///
    /// # Safety
    /// The GPU is done with every frame that was prepared without an error.
    pub unsafe fn finish(&mut self) -> Result<()> {
        self.reports.finish()
    }

    /// Makes all that a frame needs: its numbers, those that are pushed, and where it is drawn.
    fn make(
        &mut self,
        scenes: Instances<'_>,
        view: &View,
        settings: &Settings,
    ) -> Result<(Blocks, PushConstants, vk::Rect2D)> {
        let placed = scenes.placed(&self.device)?;
        let TargetView { area, size, camera, depth } =
            view.in_target(&self.device, self.plan.host.reversed)?;
        let targets = self.targets_of(area)?;
        let settings = without_background(settings);
        check_method(&settings)?;
        let mut frame = self.frame.describe(&placed, &camera, &settings, size)?;
        self.plan.check(&frame.variant)?;
        let origin = [area.offset.x as f32, area.offset.y as f32];
        frame.blocks.frame.origin = origin;
        let Description { blocks, variant, scenes: own } = &frame;
        let format = self.plan.seeded().filter(|_| own.iter().all(can_seed));
        let largest = placed.iter().map(|placed| placed.largest()).reduce(|a, b| Some(a?.max(b?))).flatten();
        let seed = format.zip(largest).and_then(|(format, largest)| {
            seeding::seed(format, depth, (&blocks.frame, variant.perspective), largest, variant.precision)
        });
        let bindings = targets.bindings(&subpasses::inputs(&self.plan));
        self.frame.make(&placed, &frame, targets.size, &bindings)?;
        self.deferred.keep_scenes(&scenes);
        Ok((frame.blocks, PushConstants { seed, host: layout::Subpass { depth } }, area))
    }

    /// The attachments, if these pixels are within them.
    fn targets_of(&self, area: vk::Rect2D) -> Result<Arc<Targets>> {
        let Some(targets) = &self.targets else {
            return Err(Error::Usage("there are no attachments: call `resize` first".into()));
        };
        let ends = [area.offset.x as u32 + area.extent.width, area.offset.y as u32 + area.extent.height];
        let [width, height] = targets.size;
        if ends[0] <= width && ends[1] <= height {
            Ok(targets.clone())
        } else {
            Err(Error::Usage(format!(
                "the viewport ends at ({}, {}), and the attachments have {width}x{height} px: call `resize` with the framebuffer's size",
                ends[0], ends[1]
            )))
        }
    }
}
