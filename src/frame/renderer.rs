//! Frames: makes what a frame needs when the scene or the settings change, records and submits it, reads it back.

use super::pyramid_samples::PyramidLevel;
use super::resources::{FrameResources, Retired};
use super::scene_resources::SceneResources;
use super::targets::TargetInfo;
use crate::error::Result;
use crate::geometry::Camera;
use crate::picture::Picture;
use crate::scene::Scene;
use crate::scene::instance::{Instances, Placed};
use crate::settings::Settings;
use crate::settings::{Outputs, Precision, Rasterizer};
use crate::vk::shaders::layout::Counts;
pub use crate::vk::shaders::layout::Splat;
use crate::vk::{Commands, Device, PassTime};
use std::sync::Arc;

/// What stays the same from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RenderOptions {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Images beside the picture.
    pub outputs: Outputs,
    /// Float width of the weighted sums, or of the samples of pull–push. A device that cannot blend 32-bit floats gets sums of 16, see
    /// [`Renderer::precision`].
    pub precision: Precision,
    /// What visits the pixels; `None` takes what is faster on the device.
    pub rasterizer: Option<Rasterizer>,
    /// Time the passes; see also [`Renderer::profile`].
    pub profile: bool,
    /// Count the splats by cull reason.
    pub count: bool,
    /// Run visibility, attribute and normalize as passes of their own where one dispatch over tiles could be all three: to time them, or to
    /// see what is between. The picture is the same, bit for bit.
    pub split: bool,
    /// Bound on the work of a frame on the compute path: about the maximum number of splats that each tile of 8 × 8 px visits in visibility,
    /// and again in coverage and attribute. A tile with more lacks the farthest ones, see [`FrameReport::incomplete`]. `None` visits all. The
    /// raster path has no such bound.
    pub most_splats: Option<u32>,
}

/// What is known of a rendered frame.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FrameReport {
    /// GPU time by pass, if the frame was profiled and the device has timestamps.
    pub pass_times: Vec<PassTime>,
    /// Surfels by cull reason, if they were counted.
    pub counts: Option<SplatCounts>,
    /// Whether a tile lacks splats, see [`RenderOptions::most_splats`]; in a host, also where a later frame did that is over.
    pub incomplete: bool,
}

/// Surfels by cull reason in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SplatCounts {
    /// Drawn.
    pub drawn: u32,
    /// The centre is not in front of the eye; by pull–push, not between the near and the far plane.
    pub behind: u32,
    /// The disc reaches the eye plane, or comes within 1/20000 of its distance to it; by pull–push, none.
    pub eye_plane: u32,
    /// The normal faces away, and such are culled.
    pub back: u32,
    /// Off the picture, by pull–push with the centre, or without an area on it: exactly edge-on, or too small to weigh anything.
    pub outside: u32,
    /// Not [valid](crate::geometry::Surfels::is_valid), or with an image too large for float32.
    pub invalid: u32,
}

/// Renders frames of one size on one device. One frame is under way at a time.
pub struct Renderer {
    frame: FrameResources,
    commands: Commands,
}

impl Renderer {
    /// A renderer that has made nothing for any scene yet.
    pub fn new(device: &Arc<Device>, options: RenderOptions) -> Result<Self> {
        Ok(Self {
            frame: FrameResources::new(device, options, Retired::Dropped, None)?,
            commands: Commands::new(device, options.profile)?,
        })
    }

    /// Renders a frame of a scene, or of several where they are placed, and waits for it. Makes nothing that an earlier frame of the same
    /// scenes and kind has made, if no more than one other kind came between.
    pub fn render<'a>(
        &mut self,
        scenes: impl Into<Instances<'a, Scene>>,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<FrameReport> {
        let placed = scenes.into().placed(self.frame.device())?;
        self.submit(&placed, camera, settings, false)
    }

    /// Renders a frame and reads it back.
    pub fn render_picture<'a>(
        &mut self,
        scenes: impl Into<Instances<'a, Scene>>,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<(Picture, FrameReport)> {
        let placed = scenes.into().placed(self.frame.device())?;
        let report = self.submit(&placed, camera, settings, true)?;
        let present = self.frame.present();
        let picture = present.map(|present| present.targets.picture(&present.readback));
        Ok((picture.unwrap_or_default(), report))
    }

    /// Renders a frame, and once more with its splats in slices if a tile lacked some.
    fn submit(
        &mut self,
        placed: &[Placed<'_>],
        camera: &Camera,
        settings: &Settings,
        read: bool,
    ) -> Result<FrameReport> {
        let report = self.submit_once(placed, camera, settings, read)?;
        match report.incomplete && self.frame.most_splats().is_none() {
            true => self.submit_once(placed, camera, settings, read),
            false => Ok(report),
        }
    }

    fn submit_once(
        &mut self,
        placed: &[Placed<'_>],
        camera: &Camera,
        settings: &Settings,
        read: bool,
    ) -> Result<FrameReport> {
        let (blocks, _) = self.frame.prepare(placed, camera, settings, read)?;
        let mut rec = self.commands.begin()?;
        self.frame.record(&mut rec, &blocks);
        if let Some(present) = self.frame.present().filter(|_| read) {
            present.targets.record_readback(&mut rec, &present.readback);
        }
        self.commands.submit()?;
        self.report()
    }

    /// Whether later frames are profiled, if [`RenderOptions::profile`] was asked for: what a whole frame costs is best timed without.
    pub fn profile(&mut self, on: bool) {
        self.commands.time(on);
    }

    /// Float width of the samples of the last frame, if it was pull–push's, else of the weighted sums.
    pub fn precision(&self) -> Precision {
        self.frame.precision()
    }

    /// The targets of the last frame.
    pub fn targets(&self) -> Vec<TargetInfo> {
        self.frame.present().map_or(Vec::new(), |present| present.targets.list())
    }

    /// What visits the pixels in the last frame.
    pub fn rasterizer(&self) -> Option<Rasterizer> {
        self.frame.present().map(|present| present.variant.rasterizer)
    }

    /// Memory of the splats of the last frame and what belongs to them, bytes.
    pub fn splat_bytes(&self) -> u64 {
        self.frame.splat_bytes()
    }

    /// Copies the splats of the last frame to the CPU: one a surfel, scene by scene; none if it was pull–push's.
    pub fn read_splats(&self) -> Result<Vec<Vec<Splat>>> {
        let read = self.frame.scenes().map(|scene| scene.read(self.frame.device()));
        let of_scenes = read.collect::<Result<Vec<_>>>()?;
        Ok(self.frame.places().iter().map(|[scene, number]| of_scenes[*scene][*number].clone()).collect())
    }

    /// Copies the levels of the last frame's pyramids to the CPU, fine to coarse, as they were pulled and as they were pushed; `None` if it was
    /// not pull–push's.
    pub fn read_pyramids(&self) -> Result<Option<[Vec<PyramidLevel>; 2]>> {
        let pyramids = self.frame.present().and_then(|present| present.targets.pyramids.as_ref());
        pyramids.map(|pyramids| pyramids.read(self.frame.device())).transpose()
    }

    /// What the frame that is over tells.
    fn report(&mut self) -> Result<FrameReport> {
        let counted = self.frame.present().is_some_and(|present| present.variant.count);
        Ok(FrameReport {
            pass_times: self.commands.pass_times()?,
            counts: counted.then(|| SplatCounts::of(self.frame.scenes())),
            incomplete: self.frame.learn(),
        })
    }
}

impl SplatCounts {
    /// Of so many surfels, of which these are culled.
    pub(crate) fn new(surfels: u64, Counts { culled }: Counts) -> Self {
        let [behind, eye_plane, back, outside, invalid] = culled;
        let drawn = surfels.saturating_sub(culled.iter().copied().map(u64::from).sum()) as u32;
        Self { drawn, behind, eye_plane, back, outside, invalid }
    }

    /// Those of all scenes together.
    fn of<'a>(scenes: impl Iterator<Item = &'a SceneResources> + Clone) -> Self {
        let add =
            |sum: [u32; 5], counts: Counts| std::array::from_fn(|i| sum[i].saturating_add(counts.culled[i]));
        let culled = scenes.clone().map(SceneResources::counts).fold([0; 5], add);
        Self::new(scenes.map(SceneResources::count).sum(), Counts { culled })
    }
}
