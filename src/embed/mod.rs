//! Embedding: surfels among the geometry of another renderer, the host, which owns instance, device, queue, command buffers and frame
//! pacing.
//!
//! ```text
//! once          Abilities::of ─ the host makes its device ─ Device::from_external ─ upload → Scene, Staging ─ Renderer::new
//! each frame    Renderer::prepare: records every pass of the method, outside a render pass
//!               Renderer::draw:    records a draw of the picture with its depth, inside a render pass of the host
//! ```
//!
//! Surfels may also be in buffers of the host, for example written by its simulation in every frame:
//! [`Scene::from_buffers`](crate::Scene::from_buffers) reads them in place. [`update`] writes new values to uploaded surfels.
//!
//! [`DepthShading`] darkens a host's picture, surfels and meshes alike, by its depth: eye-dome lighting and ambient occlusion.
//!
//! The engine never submits or waits: the host submits the recorded commands to one queue. The engine destroys its own objects once the
//! frames in flight that may use them are over, and never destroys the host's.
//!
//! ```no_run
//! use ash::vk;
//! use std::sync::Arc;
//! use surfel::embed::{self, Abilities, ExternalDevice, MemoryBlocks, Options, Pass, Renderer, Target, View};
//! use surfel::geometry::{Camera, Surfels};
//! use surfel::vk::{Device, DeviceLimits};
//! use surfel::{Precision, Scene, Settings};
//!
//! // Objects of the host.
//! struct Host {
//!     instance: ash::Instance,
//!     physical: vk::PhysicalDevice,
//!     device: ash::Device,
//!     family: u32,
//!     pass: vk::RenderPass,
//! }
//!
//! // Before the host creates its device: optional features to enable.
//! fn wanted(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Abilities {
//!     let abilities = unsafe { Abilities::of(instance, physical) };
//!     // VkDeviceCreateInfo takes `abilities.extensions()`, `abilities.features().core`, and the rest by `Features::chain`.
//!     abilities
//! }
//!
//! // Once. `cmd` is recording outside a render pass; keep `Staging` until the GPU has executed `cmd`.
//! unsafe fn load(host: &Host, enabled: Abilities, cmd: vk::CommandBuffer, surfels: &Surfels) -> surfel::Result<(Arc<Scene>, embed::Staging, Renderer)> {
//!     let device = unsafe {
//!         Device::from_external(ExternalDevice {
//!             instance: &host.instance,
//!             physical: host.physical,
//!             device: &host.device,
//!             queue_family: host.family,
//!             enabled,
//!             dynamic_rendering: false,
//!             labels: false,
//!             limits: DeviceLimits::default(),
//!             memory: None,
//!             memory_blocks: MemoryBlocks::default(),
//!             pipeline_cache: None,
//!         })?
//!     };
//!     let (scene, staging) = unsafe { embed::upload(&device, cmd, surfels)? };
//!     let target = Target {
//!         pass: Pass::Subpass { pass: host.pass, subpass: 0 },
//!         colours: vec![vk::Format::B8G8R8A8_SRGB],
//!         depth: Some(vk::Format::D32_SFLOAT),
//!         stencil: vk::Format::UNDEFINED,
//!         reversed: true,
//!         write_depth: true,
//!         samples: vk::SampleCountFlags::TYPE_1,
//!         picture: 0,
//!         normal: None,
//!         id: None,
//!         encode: false,
//!     };
//!     let options = Options { frames_in_flight: 2, ..Options::new(target) };
//!     Ok((Arc::new(scene), staging, unsafe { Renderer::new(&device, options)? }))
//! }
//!
//! /// Each frame.
//! unsafe fn frame(renderer: &mut Renderer, cmd: vk::CommandBuffer, scene: &Arc<Scene>, camera: Camera, viewport: vk::Viewport) -> surfel::Result<()> {
//!     unsafe { renderer.prepare(cmd, scene, &View { camera, viewport }, &Settings::default())? };
//! // The host begins its render pass and draws its own geometry.
//!     unsafe { renderer.draw(cmd) }
//! }
//! ```
#![allow(unsafe_code)]

mod attachments;
mod buffers;
mod composite;
mod deferred_destruction;
mod depth_shading;
mod drawn_alpha;
mod formats;
pub mod native;
#[cfg(feature = "window")]
mod offscreen_view;
mod options;
mod reports;
mod target;
mod upload;
mod view;

pub use crate::scene::Changes;
pub use crate::vk::{
    ABILITIES, API_VERSION, Abilities, Ability, ExternalDevice, Features, HostMemory, Location, MemoryBlocks,
    MemoryError, MemoryRequest, MemorySource, QUEUE, Staging,
};
pub use buffers::{Buffers, READ_ACCESS, READ_STAGES, Radii, Values, update};
pub use depth_shading::{DepthAttachment, DepthShading};
#[cfg(feature = "window")]
pub use offscreen_view::OffscreenView;
pub use options::Options;
pub use reports::Measured;
use reports::Reports;
pub use target::{Pass, Target};
pub use upload::{Upload, upload};
use view::TargetView;
pub use view::View;

use crate::error::{Error, Result};
use crate::frame::resources::{Disposal, FrameResources};
use crate::frame::targets::check_size;
use crate::frame::uniforms::Uniforms;
use crate::frame::variant::Variant;
use crate::frame::{FrameReport, RenderOptions};
use crate::scene::instance::Instances;
use crate::settings::Outputs;
use crate::settings::Settings;
use crate::vk::shaders::layout;
use crate::vk::{DescriptorSet, Device, Draws, HostPass, Recorder};
use ash::vk;
use composite::{Composite, CompositeKind};
use deferred_destruction::DeferredDestruction;
use std::sync::Arc;

/// Renders scenes into frames of a host.
pub struct Renderer {
    // Drop order: views before their resources.
    viewed: Option<CompositeView>,
    pending: Option<(PreparedDraw, HostPass)>,
    reports: Reports,
    deferred: DeferredDestruction,
    composites: Vec<Arc<Composite>>,
    frame: FrameResources,
    is_incomplete: bool,
    target: Target,
    device: Arc<Device>,
}

/// The composite pass and its view of a frame's targets.
struct CompositeView {
    /// Number of the targets.
    targets: u64,
    set: DescriptorSet,
    composite: Arc<Composite>,
}

/// The prepared picture and where it is drawn.
struct PreparedDraw {
    place: layout::Composite,
    area: vk::Rect2D,
}

impl Renderer {
    /// Creates a renderer without scene resources. Returns an error for an unsupported target.
    ///
    /// # Safety
    /// `options.target` describes the render pass correctly. The pass outlives the renderer, because pipelines are cached by its handle.
    /// The renderer is dropped only after the GPU has executed all that it recorded.
    pub unsafe fn new(device: &Arc<Device>, options: Options) -> Result<Self> {
        let Options { target, frames_in_flight, precision, rasterizer, most_splats } = options;
        target.check(device)?;
        let outputs = Outputs {
            normal: target.normal.is_some(),
            depth: target.depth.is_some(),
            id: target.id.is_some(),
        };
        let size = [1, 1];
        let options =
            RenderOptions { size, outputs, precision, rasterizer, most_splats, ..Default::default() };
        Ok(Self {
            viewed: None,
            pending: None,
            deferred: DeferredDestruction::new(frames_in_flight)?,
            reports: Reports::new(frames_in_flight),
            composites: Vec::new(),
            frame: FrameResources::new(device, options, Disposal::Deferred(Vec::new()), None)?,
            is_incomplete: false,
            target,
            device: device.clone(),
        })
    }

    /// Records a frame of one scene, or of several instances, up to its picture, which [`Renderer::draw`] then draws. The picture has the
    /// size of the viewport; pixels without a surface are transparent, whatever `settings.background` is.
    ///
    /// Binds pipelines of both kinds: afterwards the host binds its compute state again, too, as after [`Renderer::draw`].
    ///
    /// After an error nothing is recorded, and there is no picture to draw.
    ///
    /// # Safety
    /// `cmd` is a primary command buffer of the device and its queue family, as frames on the raster path begin render passes of their own. It
    /// is recording outside a render pass, and is submitted to the same queue as earlier commands, after them.
    /// [`Options::frames_in_flight`] is observed.
    pub unsafe fn prepare<'a>(
        &mut self,
        cmd: vk::CommandBuffer,
        scenes: impl Into<Instances<'a>>,
        view: &View,
        settings: &Settings,
    ) -> Result<()> {
        self.is_incomplete = self.frame.learn();
        let pending = self.make(scenes.into(), view, settings);
        // Also after an error: replaced resources may be in use.
        self.deferred.extend(self.frame.take_deferred());
        let (uniforms, pending) = pending?;
        let scenes: Vec<_> = self.frame.scenes().collect();
        self.reports.begin(&self.device, &scenes, self.frame.lod())?;
        self.reports.mark(self.is_incomplete);
        self.deferred.advance();
        let (timestamps, tail) = self.reports.present();
        // SAFETY: by the caller; there is a report for each frame in flight.
        let mut rec = unsafe { Recorder::of_host_timed(&self.device, cmd, timestamps) };
        self.frame.record(&mut rec, &uniforms);
        tail.record(&mut rec, &scenes);
        if let Some(current) = self.frame.current() {
            rec.wait(&Composite::reads(&current.targets));
        }
        self.pending = Some((pending, rec.later("composite")));
        Ok(())
    }

    /// Records the draw of the last prepared picture with a depth test. Pixels of α ≥ ½ write depth, normals and ids; the others, at soft
    /// outlines, only blend, in a second draw.
    ///
    /// Binds a graphics pipeline whose layout and static state are its own. Afterwards the host binds its pipeline and all descriptor sets,
    /// and sets push constants and all dynamic state, such as viewport and scissor, again. Vertex and index buffers stay bound.
    ///
    /// # Safety
    /// `cmd`, primary or secondary, is of the device and recording inside the subpass, or the dynamic rendering, of the target. The viewport of
    /// the prepared picture lies in the render area. The commands are submitted to the same queue after those that prepared the picture, and
    /// before those that prepare the next one.
    pub unsafe fn draw(&self, cmd: vk::CommandBuffer) -> Result<()> {
        let (Some(viewed), Some((PreparedDraw { place, area }, pass))) = (&self.viewed, &self.pending) else {
            return Err(Error::Usage(
                "there is no picture to draw: prepare one, and handle its error".into(),
            ));
        };
        // SAFETY: by the caller.
        let mut draws = unsafe { Draws::of_host(&self.device, cmd, pass, *area) };
        viewed.composite.draw(&mut draws, &viewed.set, place);
        Ok(())
    }

    /// Creates the pipelines of frames of these scenes and settings, whatever the camera and the size, so that no such frame stalls: for
    /// example while a level is loaded. Nothing is recorded, and the prepared picture stays. Takes as long as the driver needs to compile
    /// shaders, on as many threads as the CPU runs at once. Another renderer on another thread can do this, too, and leave the pipelines in the
    /// device's pipeline cache.
    ///
    /// [`Renderer::prepare`] creates missing pipelines, which takes as long. Frames need others for scenes with other streams or layouts,
    /// instances instead of one scene, a parallel instead of a perspective projection, other settings than numbers, another number of lights,
    /// and [`Renderer::measure`] of counts; and where the splats of all scenes outgrow a limit of the device.
    pub fn make_pipelines<'a>(
        &mut self,
        scenes: impl Into<Instances<'a>>,
        view: &View,
        settings: &Settings,
    ) -> Result<()> {
        let placed = scenes.into().placed(&self.device)?;
        let target_view = self.target_view(view)?;
        let frame = self.frame.describe(
            &placed,
            &target_view.camera,
            &without_background(settings),
            target_view.size,
        )?;
        self.frame.make_pipelines(&frame)?;
        self.composite(&frame.variant).map(drop)
    }

    /// Sets the measurements of later frames; off by default. Counting needs other shaders, whose pipelines are created on first use.
    pub fn measure(&mut self, measured: Measured) {
        self.reports.measure(measured);
        self.frame.count(measured.counts);
    }

    /// The report of the last frame that is known to be over, without waiting: the frame [`Options::frames_in_flight`] before the last
    /// prepared one, or after [`Renderer::finish`] that one. `None` if it was not [measured](Renderer::measure). The last pass,
    /// `composite`, is inside the host's pass.
    pub fn report(&self) -> Option<&FrameReport> {
        self.reports.last()
    }

    /// Declares that every frame is over, so that [`Renderer::report`] is that of the last one. Destroys the resources that later frames
    /// need not, and releases the scenes: without it, a renderer keeps those of its last frame, and others for
    /// [`Options::frames_in_flight`] frames.
    ///
    /// # Safety
    /// The GPU has finished every frame that was prepared without an error.
    pub unsafe fn finish(&mut self) -> Result<()> {
        drop(self.frame.take_deferred());
        self.deferred.finish();
        self.reports.finish()?;
        self.is_incomplete = self.frame.learn();
        self.reports.mark(self.is_incomplete);
        Ok(())
    }

    /// Whether a tile lacked splats in a frame that was known to be over in the last call of [`Renderer::prepare`] or [`Renderer::finish`],
    /// but not in the one before. Without [`Options::most_splats`], frames as dense are complete from then on, as they are drawn in slices: a
    /// host that shows a still view prepares another frame.
    pub fn is_incomplete(&self) -> bool {
        self.is_incomplete
    }

    /// Creates the resources of a frame: its uniforms, and the draw of its picture.
    fn make(
        &mut self,
        scenes: Instances<'_>,
        view: &View,
        settings: &Settings,
    ) -> Result<(Uniforms, PreparedDraw)> {
        self.pending = None;
        let placed = scenes.placed(&self.device)?;
        let TargetView { area, size, camera, depth, .. } = self.target_view(view)?;
        self.frame.resize(size);
        let (uniforms, variant) =
            self.frame.prepare(&placed, &camera, &without_background(settings), false)?;
        self.deferred.keep_scenes(&scenes);
        let composite = self.composite(&variant)?;
        self.view(composite)?;
        let place = layout::Composite { depth, origin: [area.offset.x, area.offset.y] };
        Ok((uniforms, PreparedDraw { place, area }))
    }

    /// The view in the conventions of the target, which is validated.
    fn target_view(&self, view: &View) -> Result<TargetView> {
        let target_view = view.in_target(&self.device, self.target.depth.map(|_| self.target.reversed))?;
        check_size(&self.device, target_view.size)?;
        Ok(target_view)
    }

    /// Updates the composite's view to the current targets.
    fn view(&mut self, composite: Arc<Composite>) -> Result<()> {
        let Some(current) = self.frame.current() else { return Ok(()) };
        let same = |viewed: &CompositeView| {
            viewed.targets == current.id && Arc::ptr_eq(&viewed.composite, &composite)
        };
        if !self.viewed.as_ref().is_some_and(same) {
            let set = composite.view(&self.device, &current.targets)?;
            let old = self.viewed.replace(CompositeView { targets: current.id, set, composite });
            self.deferred.defer(old);
        }
        Ok(())
    }

    fn composite(&mut self, variant: &Variant) -> Result<Arc<Composite>> {
        let kind = CompositeKind {
            perspective: variant.perspective,
            picture: self.target.picture,
            normal: self.target.normal,
            id: self.target.id,
            reversed: self.target.depth.map(|_| self.target.reversed),
            write_depth: self.target.write_depth,
            encode: self.target.encode,
            coverage: variant.coverage,
        };
        if let Some(made) = self.composites.iter().find(|made| made.kind() == kind) {
            return Ok(made.clone());
        }
        // SAFETY: the caller of `new` guarantees that the target is correct.
        let made = Arc::new(unsafe { self.target.composite(&self.device, kind)? });
        self.composites.push(made.clone());
        Ok(made)
    }
}

/// Settings without background: the picture is blended over the host's.
fn without_background(settings: &Settings) -> Settings {
    Settings { background: None, ..settings.clone() }
}
