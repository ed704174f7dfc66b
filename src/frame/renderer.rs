//! Renderer: creates frame resources, records and submits frames, reads them back.

use super::pyramid_samples::PyramidLevel;
use super::resources::{Disposal, FrameResources};
use super::scene_resources::{SceneResources, sum};
use super::targets::TargetInfo;
use crate::error::Result;
use crate::geometry::Camera;
use crate::picture::Picture;
use crate::scene::Scene;
use crate::scene::instance::Instances;
use crate::settings::Settings;
use crate::settings::{Outputs, Precision, Rasterizer, RasterizerChoice, RasterizerReason};
use crate::vk::shaders::layout::Counts;
pub use crate::vk::shaders::layout::Splat;
use crate::vk::{Commands, Device, PassTime};
use bytemuck::Zeroable;
use std::sync::Arc;

/// Options that apply to all frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RenderOptions {
    /// Width and height, px.
    pub size: [u32; 2],
    /// Outputs in addition to colour.
    pub outputs: Outputs,
    /// Float width of the weighted sums, or of the samples of pull–push. Devices that cannot blend 32-bit floats use 16 for sums: see
    /// [`Renderer::precision`].
    pub precision: Precision,
    /// Rasterizer.
    pub rasterizer: RasterizerChoice,
    /// Time the passes; see also [`Renderer::profile`].
    pub profile: bool,
    /// Count the splats by cull reason.
    pub count: bool,
    /// Run visibility, attribute and normalize as separate passes on the tile path, and the last step of push apart from shade, to time them
    /// or to inspect intermediate targets. The picture is identical bit by bit.
    pub split: bool,
    /// Bound on the work of a frame on the compute path: about the maximum number of splats that each tile of 8 × 8 px visits in visibility,
    /// and again in coverage and attribute. A tile with more lacks the farthest ones, see [`FrameReport::incomplete`]. `None` visits all: on
    /// devices that stop long loops ([`Capabilities::limited_loops`](crate::vk::Capabilities::limited_loops)), dense frames are rendered in
    /// slices, and a frame of which a tile lacks splats is rendered again, sliced. The raster path has no such bound, so that
    /// frames of splats with a bound take the compute path, or are rejected.
    pub most_splats: Option<u32>,
}

/// Report of a rendered frame.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct FrameReport {
    /// GPU time by pass, if the frame was profiled and the device has timestamps.
    pub pass_times: Vec<PassTime>,
    /// Surfels by cull reason, if they were counted.
    pub counts: Option<SplatCounts>,
    /// Culled surfels that were not even read, if they were counted: the compute path culls clusters of 64 consecutive surfels by their bounds.
    pub culled_in_clusters: u32,
    /// Level of detail, px: [`Settings::lod`], or more to keep to [`Settings::max_points`].
    pub lod: f32,
    /// Whether a tile lacks splats, see [`RenderOptions::most_splats`]; in a host, also where a later frame did that is over.
    pub incomplete: bool,
}

/// Surfels by cull reason in a frame. Each counts once: one that is culled with its cluster ([`FrameReport::culled_in_clusters`]) for a reason
/// that all of the cluster have.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct SplatCounts {
    /// Not culled.
    pub drawn: u32,
    /// The centre is not in front of the eye; by pull–push, not between the near and the far plane.
    pub behind: u32,
    /// The disc reaches the eye plane, or comes within 1/20000 of its distance to it; by pull–push, none.
    pub eye_plane: u32,
    /// Back faces, if these are culled.
    pub back: u32,
    /// Outside the viewport (pull–push: with the centre), or without an area on it: exactly edge-on, or too small to have a weight.
    pub outside: u32,
    /// Not [valid](crate::geometry::Surfels::is_valid), or with an image too large for float32.
    pub invalid: u32,
    /// Of another level of detail than the one that is drawn at their positions, in scenes with levels.
    pub other_level: u32,
    /// With their cluster behind the nearest surface everywhere, and already in the last frame of the renderer: frames of more surfels than pixels
    /// cull these.
    pub hidden: u32,
}

/// Renders frames of one size on one device, one frame at a time.
pub struct Renderer {
    frame: FrameResources,
    commands: Commands,
}

impl Renderer {
    /// Creates a renderer; resources of scenes are created by the first frame.
    pub fn new(device: &Arc<Device>, options: RenderOptions) -> Result<Self> {
        Ok(Self {
            frame: FrameResources::new(device, options, Disposal::Immediate, None)?,
            commands: Commands::new(device, options.profile)?,
        })
    }

    /// Renders a frame of a scene, or of several placed ones, and waits for it. Creates no resources that a previous frame of the same
    /// scenes and variant created, if at most one other variant was rendered between. With levels of detail, a frame that draws more surfels may
    /// create larger lists.
    pub fn render<'a>(
        &mut self,
        scenes: impl Into<Instances<'a, Scene>>,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<FrameReport> {
        let placed = scenes.into().placed(self.frame.device())?;
        loop {
            let (uniforms, _) = self.frame.prepare(&placed, camera, settings, false)?;
            self.frame.record(&mut self.commands.begin()?, &uniforms);
            self.commands.submit()?;
            let report = self.report()?;
            if !self.lacks_slices(&report) {
                return Ok(report);
            }
        }
    }

    /// Renders a frame and reads it back.
    pub fn render_picture<'a>(
        &mut self,
        scenes: impl Into<Instances<'a, Scene>>,
        camera: &Camera,
        settings: &Settings,
    ) -> Result<(Picture, FrameReport)> {
        let placed = scenes.into().placed(self.frame.device())?;
        loop {
            let (uniforms, _) = self.frame.prepare(&placed, camera, settings, true)?;
            let mut rec = self.commands.begin()?;
            self.frame.record(&mut rec, &uniforms);
            let current = self.frame.current();
            current.inspect(|current| current.targets.record_readback(&mut rec, &current.readback));
            self.commands.submit()?;
            let report = self.report()?;
            if self.lacks_slices(&report) {
                continue;
            }
            let current = self.frame.current();
            let picture = current.map(|current| current.targets.picture(&current.readback));
            return Ok((picture.unwrap_or_default(), report));
        }
    }

    /// Whether the frame is to be rendered again, in slices, because a tile lacks splats without a bound on them.
    fn lacks_slices(&self, report: &FrameReport) -> bool {
        let sliced = self.frame.current().is_none_or(|current| current.variant.sliced);
        let can_slice =
            self.frame.device().capabilities().limited_loops && self.frame.most_splats().is_none();
        report.incomplete && !sliced && can_slice
    }

    /// Enables or disables profiling of later frames, if [`RenderOptions::profile`] is set: the cost of a whole frame is best measured
    /// without.
    pub fn profile(&mut self, on: bool) {
        self.commands.time(on);
    }

    /// Float width of the last frame's samples (pull–push) or weighted sums.
    pub fn precision(&self) -> Precision {
        self.frame.precision()
    }

    /// The targets of the last frame.
    pub fn targets(&self) -> Vec<TargetInfo> {
        self.frame.current().map_or(Vec::new(), |current| current.targets.list())
    }

    /// Rasterizer of the last frame.
    pub fn rasterizer(&self) -> Option<Rasterizer> {
        self.frame.current().map(|current| current.variant.rasterizer)
    }

    /// Reason for the rasterizer of the last frame.
    pub fn rasterizer_reason(&self) -> Option<RasterizerReason> {
        self.frame.rasterizer_reason()
    }

    /// Memory of splats, attributes and counters of the last frame, bytes.
    pub fn splat_bytes(&self) -> u64 {
        self.frame.splat_bytes()
    }

    /// Reads back the splats of the last frame, one per surfel, scene by scene; empty for pull–push.
    pub fn read_splats(&self) -> Result<Vec<Vec<Splat>>> {
        let read = self.frame.scenes().map(|scene| scene.read(self.frame.device()));
        let of_scenes = read.collect::<Result<Vec<_>>>()?;
        Ok(self
            .frame
            .placements()
            .iter()
            .map(|[scene, instance]| of_scenes[*scene][*instance].clone())
            .collect())
    }

    /// Reads back the pyramids of the last frame: pulled and pushed levels, fine to coarse; `None` unless it was of pull–push. An error
    /// unless it stored level 0 of the pushed pyramid: [`RenderOptions::split`] stores it.
    pub fn read_pyramids(&self) -> Result<Option<[Vec<PyramidLevel>; 2]>> {
        let pyramids = self.frame.current().and_then(|current| current.targets.pyramids.as_ref());
        pyramids.map(|pyramids| pyramids.read(self.frame.device())).transpose()
    }

    /// Reads back the tiles of 8 × 8 px that the boxes of the last frame's splats overlap, column and row of each: all others were left empty,
    /// unless splats that face away, or were hidden in the frame before, cover them. `None` if the frame has no list of them: on the raster
    /// path, by pull–push, in slices, and if stages run separately ([`RenderOptions::split`]).
    pub fn read_covered_tiles(&self) -> Result<Option<Vec<[u32; 2]>>> {
        let current = self.frame.current();
        let tiles = current.map(|current| current.targets.read_covered_tiles(self.frame.device()));
        tiles.transpose().map(Option::flatten)
    }

    /// Report of the completed frame.
    fn report(&mut self) -> Result<FrameReport> {
        let counted = self.frame.current().is_some_and(|current| current.variant.count);
        let counts = self.frame.scenes().map(SceneResources::counts).fold(Counts::zeroed(), sum);
        let surfels = self.frame.scenes().map(SceneResources::count).sum();
        Ok(FrameReport {
            pass_times: self.commands.pass_times()?,
            counts: counted.then(|| SplatCounts::new(surfels, counts)),
            culled_in_clusters: if counted { counts.in_clusters } else { 0 },
            lod: self.frame.lod(),
            incomplete: self.frame.learn(),
        })
    }
}

impl SplatCounts {
    /// Counts of so many surfels, of which these are culled.
    pub(crate) fn new(surfels: u64, Counts { culled, .. }: Counts) -> Self {
        let [behind, eye_plane, back, outside, invalid, other_level, hidden] = culled;
        let drawn = surfels.saturating_sub(culled.iter().copied().map(u64::from).sum()) as u32;
        Self { drawn, behind, eye_plane, back, outside, invalid, other_level, hidden }
    }
}
