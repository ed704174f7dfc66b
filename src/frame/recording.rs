//! Records passes: barriers, descriptor sets, push constants, workgroup and vertex counts.

use super::pass::{Commands, Domain, Pass, Programs, StepContext};
use super::resource::Resource;
use super::scene_resources::{InstanceRun, SceneResources};
use super::scene_variant::SceneVariant;
use super::splat_list::SplatList;
use super::target_descriptions::is_cleared;
use super::targets::RenderTargets;
use super::tile_list::{PYRAMID_TILE, workgroups_at};
use super::tile_rect::TileRect;
use super::variant::Variant;
use super::visible_clusters;
use crate::vk::shaders::Module;
use crate::vk::shaders::layout::{Chunk, Hierarchy};
use crate::vk::{
    Access, Buffer, ComputePipeline, DescriptorSet, DrawPipeline, Draws, Encoder, Framebuffer, Recorder, Use,
};
use ash::vk::ShaderStageFlags;
use std::collections::HashSet;
use std::sync::Arc;

/// Invocations of a workgroup of all shaders, except of tile passes.
const WORKGROUP: u64 = 64;
/// Workgroups that share the large triangles of a dispatch's instances.
const LARGE_WORKGROUPS: u32 = 256;
/// Workgroups per row of a dispatch over pixels or groups, for which it is CLUSTER_COLUMNS of `lib/visible_clusters.glsl`; within every device's
/// limits.
const WORKGROUPS_X: u32 = 32_768;

/// [`Hierarchy::fronts`] of dispatches of the splats that face the eye, and of those in the tiles of revealed clusters.
pub const FRONTS: u32 = 1;
pub const REVEALED_FRONTS: u32 = 2;

/// Columns and rows of pixels of a workgroup of passes over pixels (`lib/pixel_group.glsl`).
const PIXEL_GROUP: [u32; 2] = [16, 4];

/// Workgroups for an invocation per pixel.
pub fn grid_over_pixels([width, height]: [u32; 2]) -> [u32; 3] {
    [width.div_ceil(PIXEL_GROUP[0]), height.div_ceil(PIXEL_GROUP[1]), 1]
}

/// Workgroups for an invocation per block of 2 × 2 pixels, and per corner of such blocks.
pub fn grid_over_quads(size: [u32; 2]) -> [u32; 3] {
    grid_over_pixels(size.map(|side| side / 2 + 1))
}

/// Columns and rows of pixels of a workgroup of `filter.glsl`: of its invocations' blocks.
const BLOCK_GROUP: [u32; 2] = [16 * 4, 4 * 16];

/// Tiles of a row that an invocation of `covered.glsl` finds: STRIP.
const TILE_STRIP: u32 = 16;

/// Workgroups for an invocation per block of pixels.
fn grid_over_blocks([width, height]: [u32; 2]) -> [u32; 3] {
    [width.div_ceil(BLOCK_GROUP[0]), height.div_ceil(BLOCK_GROUP[1]), 1]
}

/// Workgroups for so many invocations, in rows: for shaders that index by both coordinates.
pub fn grid_over(invocations: u64) -> [u32; 3] {
    grid_of(invocations.div_ceil(WORKGROUP) as u32)
}

/// So many workgroups, in rows.
fn grid_of(workgroups: u32) -> [u32; 3] {
    [workgroups.min(WORKGROUPS_X), workgroups.div_ceil(WORKGROUPS_X), 1]
}

/// Workgroups for so many invocations in one row, for shaders that index by x only.
pub fn row_over(invocations: u64) -> [u32; 3] {
    [invocations.div_ceil(WORKGROUP) as u32, 1, 1]
}

/// Context in which passes are recorded.
pub struct Frame<'a> {
    /// Variant of the frame.
    pub variant: &'a Variant,
    /// Descriptor set 0 of passes over pixels.
    pub view: &'a DescriptorSet,
    /// Render targets.
    pub targets: &'a RenderTargets,
    /// Splats of all scenes, on the tile path.
    pub splats: Option<&'a SplatList>,
    /// Number of splats, padding included.
    pub splat_count: u64,
    /// The tiles that the splats of each slice may cover, of a sliced frame.
    pub tiles_of_slices: &'a [TileRect],
    /// See [`super::RenderOptions::most_splats`].
    pub most_splats: Option<u32>,
    /// Colour of the background and its α: linear RGB.
    pub background: [f32; 4],
    /// Number of the frame.
    pub number: u32,
    /// Instances in draw order: that of the frame.
    pub runs: Vec<InstanceRun<'a>>,
    /// Instances batch by batch, for dispatches, whose order is free: two dispatches must not write through one descriptor set.
    pub batches: Vec<InstanceRun<'a>>,
}

/// A pass with its descriptor set, framebuffer and pipelines.
pub struct PreparedPass {
    pub pass: &'static Pass,
    /// Accesses of its shaders.
    pub accesses: Vec<(Resource, Access)>,
    /// Descriptor set 1.
    pub targets: DescriptorSet,
    /// Framebuffer of a raster pass, except in a host's render pass.
    pub framebuffer: Option<Framebuffer>,
    /// Pipelines of the frame, or of each instance in order.
    pub pipelines: Vec<Pipelines>,
}

/// Pipelines of a pass for a frame or a scene, with their domains.
pub type Pipelines = Arc<Vec<(Domain, Pipeline)>>;

/// A compute or graphics pipeline.
pub enum Pipeline {
    Compute(ComputePipeline),
    Draw(DrawPipeline),
}

impl PreparedPass {
    /// Records the pass, if it has work.
    pub fn record(&self, rec: &mut Recorder<'_>, frame: &Frame<'_>) {
        frame.clear(rec, self.pass.clears);
        let has_pipelines = self.pipelines.iter().any(|pipelines| !pipelines.is_empty());
        match &self.pass.commands {
            Commands::Steps(record) => {
                record(
                    &StepContext { pipeline: self.first(), targets: &self.targets, frame, prepared: self },
                    rec,
                );
            }
            Commands::Dispatches if has_pipelines => {
                let uses = frame.uses(&self.accesses);
                let mut enc = rec.pass(self.pass.name, &uses);
                for slice in 0..self.slices(frame) {
                    if self.slices(frame) > 1 && frame.tiles([slice, self.slices(frame)]).is_empty() {
                        continue;
                    }
                    if slice > 0 {
                        enc.barrier(&uses);
                    }
                    self.dispatch(&mut enc, frame, slice);
                }
            }
            Commands::Draws(_) => {
                let Some(framebuffer) = &self.framebuffer else { return };
                let mut enc = rec.pass(self.pass.name, &frame.uses(&self.accesses));
                self.draw(&mut enc.render(framebuffer), frame, &());
            }
            Commands::Dispatches => {}
        }
    }

    /// Number of dispatches over tiles, each with a slice of the splats; 1 for other passes.
    fn slices(&self, frame: &Frame<'_>) -> u32 {
        let pipelines = self.pipelines.first().map_or(&[][..], |pipelines| pipelines);
        let over_tiles =
            pipelines.iter().any(|(domain, _)| [Domain::Tiles, Domain::FrontTiles].contains(domain));
        match frame.splats {
            Some(splats) if over_tiles && frame.variant.sliced => splats.slices(frame.splat_count),
            _ => 1,
        }
    }

    /// The pipeline of a pass of several steps.
    fn first(&self) -> Option<&ComputePipeline> {
        match self.pipelines.first()?.first()? {
            (_, Pipeline::Compute(pipeline)) => Some(pipeline),
            (_, Pipeline::Draw(_)) => None,
        }
    }

    /// Its pipelines, each with the run of instances it is recorded for, if any.
    fn each<'a>(
        &'a self,
        runs: &'a [InstanceRun<'_>],
    ) -> impl Iterator<Item = (Domain, &'a Pipeline, Option<&'a InstanceRun<'a>>)> {
        let runs: Vec<_> = match self.pass.programs {
            Programs::OfScene(_) => runs.iter().map(|run| (run.index, Some(run))).collect(),
            Programs::OfFrame(_) => vec![(0, None)],
        };
        let pipelines_of = |(index, run)| self.pipelines.get(index).map(|pipelines| (pipelines, run));
        let all = runs.into_iter().filter_map(pipelines_of);
        all.flat_map(|(pipelines, run)| {
            pipelines.iter().map(move |(domain, pipeline)| (*domain, pipeline, run))
        })
    }

    /// Records one dispatch per program; over tiles, of one slice.
    fn dispatch(&self, enc: &mut Encoder<'_, '_>, frame: &Frame<'_>, slice: u32) {
        for (domain, pipeline, run) in self.each(&frame.batches) {
            let Pipeline::Compute(pipeline) = pipeline else { continue };
            match run {
                None => self.dispatch_of_frame(enc, frame, (domain, pipeline), slice),
                Some(run) => self.dispatch_of_run(enc, frame, (domain, pipeline), run),
            }
        }
    }

    /// Descriptor sets: the one of the frame or the scene, that of the pass, and a third one, if any.
    fn sets<'a>(
        &'a self,
        first: &'a DescriptorSet,
        third: Option<&'a DescriptorSet>,
    ) -> Vec<&'a DescriptorSet> {
        [Some(first), Some(&self.targets), third].into_iter().flatten().collect()
    }

    /// Records the dispatch of a program over pixels or tiles; over rectangles of tiles, of one slice.
    fn dispatch_of_frame(
        &self,
        enc: &mut Encoder<'_, '_>,
        frame: &Frame<'_>,
        (domain, pipeline): (Domain, &ComputePipeline),
        slice: u32,
    ) {
        let sets = self.sets(frame.view, frame.pyramid_of(self.pass));
        let targets = frame.targets;
        let [columns, rows] = targets.tiles();
        if let Some(splats) = frame.splats {
            let whole = splats.hierarchy([0, 1], frame.most_steps(), frame.number);
            if let Some(list) = domain.tile_list() {
                let Some(list) = targets.buffer(list) else { return };
                let fronts = match domain {
                    Domain::CoveredFrontTiles => FRONTS,
                    Domain::RevealedTiles => REVEALED_FRONTS,
                    _ => 0,
                };
                return enc.dispatch_indirect(pipeline, &sets, &Hierarchy { fronts, ..whole }, (list, 0));
            }
            match domain {
                Domain::Tiles | Domain::FrontTiles => {
                    let slices = [slice, self.slices(frame)];
                    let tiles = frame.tiles(slices);
                    let [columns, rows] = tiles.size();
                    let fronts = if domain == Domain::FrontTiles { FRONTS } else { 0 };
                    let hierarchy = splats.hierarchy(slices, frame.most_steps(), frame.number);
                    let hierarchy = Hierarchy { fronts, first_tile: tiles.first, ..hierarchy };
                    return enc.dispatch(pipeline, &sets, &hierarchy, [columns, rows, 1]);
                }
                Domain::WholeTiles => return enc.dispatch(pipeline, &sets, &whole, [columns, rows, 1]),
                Domain::TileStrips => {
                    let strips = u64::from(columns.div_ceil(TILE_STRIP)) * u64::from(rows);
                    return enc.dispatch(pipeline, &sets, &whole, grid_over(strips));
                }
                _ => {}
            }
        }
        let workgroups = match domain {
            Domain::TileSlots => grid_over(u64::from(columns) * u64::from(rows)),
            Domain::RowsOfPyramidTiles => grid_over(u64::from(PYRAMID_TILE) * targets.pyramid_tiles()),
            Domain::Blocks => grid_over_blocks(targets.size),
            Domain::Quads => grid_over_quads(targets.size),
            _ => grid_over_pixels(targets.size),
        };
        enc.dispatch(pipeline, &sets, &(), workgroups);
    }

    /// Records the dispatches of a program over a run of instances of a scene, one per chunk.
    fn dispatch_of_run(
        &self,
        enc: &mut Encoder<'_, '_>,
        frame: &Frame<'_>,
        (domain, pipeline): (Domain, &ComputePipeline),
        run: &InstanceRun<'_>,
    ) {
        for mut chunk_run in run.chunks(domain.scope(), self.pass) {
            let sets = self.sets(chunk_run.set, frame.pyramid_of(self.pass).or(chunk_run.counts));
            if [Domain::VisibleClusters, Domain::RevealedClusters].contains(&domain) {
                let Some((list, start)) = chunk_run.visible else { continue };
                let revealed = u32::from(domain == Domain::RevealedClusters);
                let workgroups = (list, start + u64::from(revealed) * visible_clusters::COUNTS);
                let chunk = Chunk { revealed, ..chunk_run.chunk };
                enc.dispatch_indirect(pipeline, &sets, &chunk, workgroups);
                continue;
            }
            if domain == Domain::Clusters {
                let groups = grid_of(chunk_run.chunk.group_count);
                enc.dispatch(pipeline, &sets, &chunk_run.chunk, groups);
                continue;
            }
            if domain.tile_list() == Some(Resource::OccupiedTiles) {
                let Some(list) = frame.targets.buffer(Resource::OccupiedTiles) else { continue };
                // The list does not know how many instances there are.
                for instance in 0..chunk_run.instances {
                    let first_instance = chunk_run.chunk.first_instance + instance;
                    let chunk = Chunk { first_instance, ..chunk_run.chunk };
                    enc.dispatch_indirect(pipeline, &sets, &chunk, (list, workgroups_at(0)));
                }
                continue;
            }
            if domain == Domain::SurfelSlots {
                chunk_run.instances = chunk_run.capacity;
            }
            let [x, y, _] = match domain {
                Domain::Surfels | Domain::Lines | Domain::Triangles => row_over(chunk_run.chunk.count.into()),
                Domain::SurfelSlots => row_over(chunk_run.chunk.instance_stride.into()),
                Domain::LargeTriangles => [LARGE_WORKGROUPS.div_ceil(chunk_run.instances), 1, 1],
                _ => grid_over_pixels(frame.targets.size),
            };
            enc.dispatch(pipeline, &sets, &chunk_run.chunk, [x, y, chunk_run.instances]);
        }
    }

    /// Records one draw per program inside a render pass; `push` are the push constants of full-screen draws.
    pub fn draw(&self, draws: &mut Draws<'_>, frame: &Frame<'_>, push: &impl bytemuck::NoUninit) {
        for (domain, pipeline, run) in self.each(&frame.runs) {
            let Pipeline::Draw(pipeline) = pipeline else { continue };
            let sets = |first| -> Vec<&DescriptorSet> { vec![first, &self.targets] };
            let Some(run) = run else {
                draws.draw(pipeline, &sets(frame.view), push, 3);
                continue;
            };
            for chunk_run in run.chunks(domain.scope(), self.pass) {
                let vertices = if domain == Domain::Points { 1 } else { 3 } * chunk_run.chunk.count;
                draws.draw(pipeline, &sets(chunk_run.set), &chunk_run.chunk, vertices * chunk_run.instances);
            }
        }
    }
}

impl<'a> Frame<'a> {
    /// Steps of a walk over a tile that visits about [`Frame::most_splats`]: one per two splats, per batch, and per group of boxes, of which
    /// there is about one a batch.
    fn most_steps(&self) -> u32 {
        let Some(most) = self.most_splats else { return i32::MAX as u32 };
        let lanes = u64::from(self.variant.workgroup.lanes);
        let steps = u64::from(most).div_ceil(lanes) * (lanes / 2 + 2);
        steps.clamp(1, i32::MAX as u64) as u32
    }

    /// The tiles of a dispatch over tiles: those that any splat may cover where it is the first slice, which initializes them, or the last one,
    /// which completes them; otherwise those that its splats may cover.
    fn tiles(&self, [slice, slices]: [u32; 2]) -> TileRect {
        let is_between = slice > 0 && slice + 1 < slices;
        let of_slice = self.tiles_of_slices.get(slice as usize).filter(|_| is_between);
        let of_all = || self.tiles_of_slices.iter().copied().reduce(TileRect::with);
        of_slice.copied().or_else(of_all).unwrap_or_else(|| TileRect::all(self.targets.size))
    }

    /// The buffers and images of these resources that the frame has, with their accesses.
    pub fn uses(&self, accesses: &[(Resource, Access)]) -> Vec<Use> {
        let mut uses = Vec::new();
        for (resource, access) in accesses {
            let of_splats = self.splats.and_then(|splats| splats.buffer(*resource));
            match of_splats {
                Some(buffer) => uses.push(buffer.with(*access)),
                None if resource.is_of_scene() => {
                    uses.extend(self.of_scenes(*resource).map(|buffer| buffer.with(*access)));
                }
                None => self.targets.extend_uses(&mut uses, *resource, *access),
            }
        }
        uses
    }

    /// The buffers of a resource, scene by scene.
    fn of_scenes(&self, resource: Resource) -> impl Iterator<Item = &'a Buffer> {
        self.scenes_with(resource).flat_map(move |scene| scene.buffers(resource))
    }

    /// The scenes that may have a resource; counts may exist in frames that do not count.
    fn scenes_with(&self, resource: Resource) -> impl Iterator<Item = &'a SceneResources> {
        let counted = resource != Resource::Counts || self.variant.count;
        let first = self.batches.iter().filter(move |run| counted && run.first == 0);
        first.map(|run| run.scene)
    }

    /// Clears the resources that the frame has.
    pub fn clear(&self, rec: &mut Recorder<'_>, resources: &[Resource]) {
        let resources = resources.iter().filter(|resource| is_cleared(**resource, self.variant));
        let write: Vec<_> = resources.clone().map(|resource| (*resource, Access::COPY_WRITE)).collect();
        let uses = self.uses(&write);
        if uses.is_empty() {
            return;
        }
        let mut enc = rec.pass("clear", &uses);
        for resource in resources {
            self.targets.clear(&mut enc, *resource, self.background);
            self.scenes_with(*resource).for_each(|scene| scene.clear(&mut enc, *resource));
        }
    }

    /// Descriptor set 2 of a pass without steps that writes the pulled pyramid.
    fn pyramid_of(&self, pass: &Pass) -> Option<&'a DescriptorSet> {
        let pulled = self.targets.pyramids.as_ref()?.of(Resource::Pulled);
        pulled.filter(|_| pass.writes.contains(&Resource::Pulled)).map(|pyramid| &pyramid.written)
    }
}

impl<'a> StepContext<'a> {
    /// The compute pipelines of each scene, with its instances.
    pub fn of_scenes(&self) -> Vec<(Vec<&'a ComputePipeline>, &'a InstanceRun<'a>)> {
        let scenes = self.frame.batches.iter().filter_map(|run| {
            let of_scene = self.prepared.pipelines.get(run.index)?.iter();
            let compute = of_scene.filter_map(|(_, pipeline)| match pipeline {
                Pipeline::Compute(pipeline) => Some(pipeline),
                Pipeline::Draw(_) => None,
            });
            Some((compute.collect(), run))
        });
        scenes.collect()
    }

    /// Descriptor sets of a step that reads one of the pyramids and writes one.
    pub fn pyramid_sets(&self, [from, to]: [usize; 2]) -> Vec<&'a DescriptorSet> {
        let Some(pyramids) = &self.frame.targets.pyramids else { return Vec::new() };
        let pyramids = [&pyramids.pyramids[to].written, &pyramids.pyramids[from].read];
        [self.frame.view, self.targets].into_iter().chain(pyramids).collect()
    }

    /// Descriptor sets of a step that only reads one of the pyramids.
    pub fn sets_to_read(&self, from: usize) -> Vec<&'a DescriptorSet> {
        let pyramid = self.frame.targets.pyramids.as_ref().map(|pyramids| &pyramids.pyramids[from].read);
        [self.frame.view, self.targets].into_iter().chain(pyramid).collect()
    }

    /// Descriptor sets of shade, which only reads the pyramids.
    pub fn shade_sets(&self) -> Vec<&'a DescriptorSet> {
        let Some(pyramids) = &self.frame.targets.pyramids else { return Vec::new() };
        let pyramids =
            [Resource::Pushed, Resource::Pulled].map(|role| pyramids.of(role).map(|pyramid| &pyramid.read));
        [self.frame.view, self.targets].into_iter().chain(pyramids.into_iter().flatten()).collect()
    }
}

impl Pass {
    /// Accesses of its shaders in frames of these scenes; with its attachments, if `to_own` targets.
    pub fn accesses(
        &self,
        variant: &Variant,
        scenes: &[SceneVariant],
        to_own: bool,
    ) -> Vec<(Resource, Access)> {
        let programs = match &self.programs {
            Programs::OfFrame(programs) => programs(variant),
            Programs::OfScene(programs) => {
                let distinct: HashSet<_> = scenes.iter().collect();
                distinct.into_iter().flat_map(programs).collect()
            }
        };
        let seen_by = |resource: Resource| {
            let modules = programs.iter().flat_map(|program| program.modules());
            let is_seen =
                |module: &Module| module.resources.iter().any(|(declared, _)| resource.is_bound_as(declared));
            modules
                .filter(|module| is_seen(module))
                .fold(ShaderStageFlags::empty(), |all, module| all | module.stage)
        };
        let read = self.reads.iter().map(|resource| (*resource, false));
        let all = read.chain(self.writes.iter().map(|resource| (*resource, true)));
        let touched = all.map(|(resource, write)| (resource, seen_by(resource), write));
        let touched = touched.filter(|(_, stages, _)| !stages.is_empty());
        let access = |(resource, stages, write)| {
            let access = Access::of_shader(stages, write);
            let over = |list| programs.iter().any(|program| program.domain.tile_list() == Some(list));
            let indirect = match resource {
                Resource::VisibleClusters => !write,
                Resource::CoveredTiles
                | Resource::OpenTiles
                | Resource::EdgeTiles
                | Resource::RevealedTiles
                | Resource::OccupiedTiles => over(resource),
                _ => false,
            };
            (resource, if indirect { access.and_indirect() } else { access })
        };
        let mut list: Vec<_> = touched.map(access).collect();
        match &self.commands {
            Commands::Draws(targets) if to_own => list.extend(targets.accesses()),
            _ => {}
        }
        list
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_coordinate_gives_one_row() {
        // The limit of 65,535 workgroups.
        assert_eq!(row_over(4_194_240), [65_535, 1, 1]);
        let [x, y, _] = grid_over(4_194_240);
        assert!(y > 1 && u64::from(x) * u64::from(y) * WORKGROUP >= 4_194_240);
    }
}
