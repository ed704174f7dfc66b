//! How the passes of a frame are recorded: barriers, descriptor sets, push constants, numbers of workgroups and vertices.

use super::pass::{Commands, Over, Pass, Programs, Steps};
use super::pyramids::Pyramids;
use super::resource::Resource;
use super::scene_resources::{Run, SceneResources};
use super::splat_list::SplatList;
use super::targets::RenderTargets;
use super::variant::{SceneVariant, Variant};
use crate::vk::shaders::Module;
use crate::vk::{
    Access, Buffer, ComputePipeline, DescriptorSet, DrawPipeline, Draws, Encoder, Framebuffer, Recorder, Use,
};
use ash::vk::ShaderStageFlags;
use std::collections::HashSet;
use std::sync::Arc;

/// Invocations in a workgroup of every shader.
const WORKGROUP: u64 = 64;
/// Workgroups among which large triangles of the instances of a dispatch are dealt out.
const LARGE_WORKGROUPS: u32 = 256;
/// Workgroups in a row of a dispatch over pixels; every device allows as many.
const WORKGROUPS_X: u32 = 32_768;

/// Workgroups for so many invocations, in rows: for shaders that number them by both coordinates.
pub fn grid_over(invocations: u64) -> [u32; 3] {
    let workgroups = invocations.div_ceil(WORKGROUP) as u32;
    [workgroups.min(WORKGROUPS_X), workgroups.div_ceil(WORKGROUPS_X), 1]
}

/// Workgroups in one row for so many invocations, for shaders that number them by one coordinate.
fn row_over(invocations: u64) -> [u32; 3] {
    [invocations.div_ceil(WORKGROUP) as u32, 1, 1]
}

/// What passes are recorded with.
pub struct Frame<'a> {
    /// What the frame is.
    pub variant: &'a Variant,
    /// Descriptor set 0 of passes over pixels.
    pub view: &'a DescriptorSet,
    /// What passes draw to, and compute.
    pub targets: &'a RenderTargets,
    /// The splats of all scenes, for tiles.
    pub splats: Option<&'a SplatList>,
    /// How many of them there are.
    pub splat_count: u64,
    /// See [`super::RenderOptions::most_splats`].
    pub most_splats: Option<u32>,
    /// Number of the frame.
    pub number: u32,
    /// The instances of scenes for draws: in the order of the frame.
    pub runs: Vec<Run<'a>>,
    /// The same for dispatches, whose order does not matter: those of a batch together, as two dispatches must not write what one descriptor set names.
    pub batches: Vec<Run<'a>>,
}

/// A pass with all that its commands need.
pub struct Prepared {
    pub pass: &'static Pass,
    /// How its shaders touch what it reads and writes.
    pub accesses: Vec<(Resource, Access)>,
    /// What it sees of the targets: descriptor set 1, if it has programs.
    pub targets: Option<DescriptorSet>,
    /// What it draws to; in render passes of its own.
    pub framebuffer: Option<Framebuffer>,
    /// Its pipelines: those of the frame, or of each instance in its order.
    pub pipelines: Vec<Pipelines>,
}

/// The pipelines of a pass for a scene, or for a frame, each with what it runs over.
pub type Pipelines = Arc<Vec<(Over, Pipeline)>>;

/// A pipeline.
pub enum Pipeline {
    Compute(ComputePipeline),
    Draw(DrawPipeline),
}

impl Prepared {
    /// Records the pass, unless there is nothing for it to do.
    pub fn record(&self, rec: &mut Recorder<'_>, frame: &Frame<'_>) {
        frame.clear(rec, self.pass.clears);
        let there = self.pipelines.iter().any(|pipelines| !pipelines.is_empty());
        match &self.pass.commands {
            Commands::Steps(record) => {
                record(&Steps { pipeline: self.first(), targets: self.targets.as_ref(), frame }, rec);
            }
            Commands::Dispatches if there => {
                for slice in 0..self.slices(frame) {
                    let mut enc = rec.pass(self.pass.name, &frame.uses(&self.accesses));
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

    /// How many dispatches over tiles follow each other, each with a slice of the splats; 1 of all other passes.
    fn slices(&self, frame: &Frame<'_>) -> u32 {
        let pipelines = self.pipelines.first().map_or(&[][..], |pipelines| pipelines);
        let over_tiles = pipelines.iter().any(|(over, _)| *over == Over::Tiles);
        match frame.splats {
            Some(splats) if over_tiles && frame.variant.sliced => splats.slices(frame.splat_count),
            _ => 1,
        }
    }

    /// Its only pipeline, of a pass of several steps.
    fn first(&self) -> Option<&ComputePipeline> {
        match self.pipelines.first()?.first()? {
            (_, Pipeline::Compute(pipeline)) => Some(pipeline),
            (_, Pipeline::Draw(_)) => None,
        }
    }

    /// Its pipelines with what they are of: the frame, or each of these runs of instances.
    fn each<'a>(
        &'a self,
        runs: &'a [Run<'_>],
    ) -> impl Iterator<Item = (Over, &'a Pipeline, Option<&'a Run<'a>>)> {
        let runs: Vec<_> = match self.pass.programs {
            Programs::OfScene(_) => runs.iter().map(|run| (run.place, Some(run))).collect(),
            Programs::OfFrame(_) | Programs::None => vec![(0, None)],
        };
        let made = |(place, run)| self.pipelines.get(place).map(|pipelines| (pipelines, run));
        let all = runs.into_iter().filter_map(made);
        all.flat_map(|(pipelines, run)| pipelines.iter().map(move |(over, made)| (*over, made, run)))
    }

    /// Records a dispatch of each program; of one over tiles with a slice of the splats.
    fn dispatch(&self, enc: &mut Encoder<'_, '_>, frame: &Frame<'_>, slice: u32) {
        for (over, pipeline, run) in self.each(&frame.batches) {
            let Pipeline::Compute(pipeline) = pipeline else { continue };
            let pyramid = frame.pyramid_of(self.pass);
            let three = |first, third| -> Vec<&DescriptorSet> {
                [Some(first), self.targets.as_ref(), third].into_iter().flatten().collect()
            };
            let Some(run) = run else {
                let sets = three(frame.view, pyramid);
                match (over, frame.splats) {
                    (Over::Tiles, Some(splats)) => {
                        let [columns, rows] = frame.targets.tiles();
                        let slices = [slice, self.slices(frame)];
                        let hierarchy = splats.hierarchy(slices, frame.most_steps(), frame.number);
                        enc.dispatch(pipeline, &sets, &hierarchy, [columns, rows, 1]);
                    }
                    _ => enc.dispatch(pipeline, &sets, &(), grid_over(frame.targets.pixels())),
                }
                continue;
            };
            for mut part in run.parts(over.scope(), self.pass) {
                if over == Over::Slots {
                    part.instances = part.room;
                }
                let [x, y, _] = match over {
                    Over::Surfels | Over::Lines | Over::Triangles => row_over(part.chunk.count.into()),
                    Over::Slots => row_over(part.chunk.instance_stride.into()),
                    Over::LargeTriangles => [LARGE_WORKGROUPS.div_ceil(part.instances), 1, 1],
                    _ => grid_over(frame.targets.pixels()),
                };
                let sets = three(part.set, pyramid.or(part.counts));
                enc.dispatch(pipeline, &sets, &part.chunk, [x, y, part.instances]);
            }
        }
    }

    /// Records a draw of each program, inside a render pass; `push` are the push constants of what is drawn over the whole picture.
    pub fn draw(&self, draws: &mut Draws<'_>, frame: &Frame<'_>, push: &impl bytemuck::NoUninit) {
        for (over, pipeline, run) in self.each(&frame.runs) {
            let Pipeline::Draw(pipeline) = pipeline else { continue };
            let sets =
                |first| -> Vec<&DescriptorSet> { std::iter::once(first).chain(&self.targets).collect() };
            let Some(run) = run else {
                draws.draw(pipeline, &sets(frame.view), push, 3);
                continue;
            };
            for part in run.parts(over.scope(), self.pass) {
                let vertices = if over == Over::Points { 1 } else { 3 } * part.chunk.count;
                draws.draw(pipeline, &sets(part.set), &part.chunk, vertices * part.instances);
            }
        }
    }
}

impl<'a> Frame<'a> {
    /// Steps of a walk over a tile that visits about [`Frame::most_splats`]: two splats a step, and one step for each batch of a team and
    /// for each group of siblings, of which there is about one a batch.
    fn most_steps(&self) -> u32 {
        let Some(most) = self.most_splats else { return i32::MAX as u32 };
        let lanes = u64::from(self.variant.team.lanes);
        let steps = u64::from(most).div_ceil(lanes) * (lanes / 2 + 2);
        steps.clamp(1, i32::MAX as u64) as u32
    }

    /// Each buffer and image of these that the frame has, as it is touched.
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

    /// A resource of each scene that has it, once.
    fn of_scenes(&self, resource: Resource) -> impl Iterator<Item = &'a Buffer> {
        self.scenes_with(resource).flat_map(move |scene| scene.buffers(resource))
    }

    /// The scenes, each once, that may have a resource: counts may be there and not be wanted.
    fn scenes_with(&self, resource: Resource) -> impl Iterator<Item = &'a SceneResources> {
        let wanted = resource != Resource::Counts || self.variant.count;
        let first = self.batches.iter().filter(move |run| wanted && run.first == 0);
        first.map(|run| run.scene)
    }

    /// Empties these, as far as the frame has them.
    pub fn clear(&self, rec: &mut Recorder<'_>, resources: &[Resource]) {
        let write: Vec<_> = resources.iter().map(|resource| (*resource, Access::COPY_WRITE)).collect();
        let uses = self.uses(&write);
        if uses.is_empty() {
            return;
        }
        let mut enc = rec.pass("clear", &uses);
        for resource in resources {
            self.targets.clear(&mut enc, *resource);
            self.scenes_with(*resource).for_each(|scene| scene.clear(&mut enc, *resource));
        }
    }

    /// Descriptor set 2 of a pass that is not of several steps: what it writes of what is pulled, or reads of what is pushed.
    fn pyramid_of(&self, pass: &Pass) -> Option<&'a DescriptorSet> {
        let Pyramids { storage, sets, .. } = self.targets.pyramids.as_ref()?;
        if pass.writes.contains(&Resource::Pulled) {
            return Some(&sets[storage.pull(0)[1]]);
        }
        pass.reads.contains(&Resource::Pushed).then(|| &sets[storage.push(0)[1]])
    }
}

impl<'a> Steps<'a> {
    /// The descriptor sets of a step that reads one of the pyramids and writes one.
    pub fn pyramid_sets(&self, [from, to]: [usize; 2]) -> Vec<&'a DescriptorSet> {
        let Some(pyramids) = &self.frame.targets.pyramids else { return Vec::new() };
        let pyramids = [to, from].map(|which| &pyramids.sets[which]);
        std::iter::once(self.frame.view).chain(self.targets).chain(pyramids).collect()
    }
}

impl Pass {
    /// How its shaders touch what it reads and writes in frames of such scenes; with what it draws `to_own` targets.
    pub fn accesses(
        &self,
        variant: &Variant,
        scenes: &[SceneVariant],
        to_own: bool,
    ) -> Vec<(Resource, Access)> {
        let programs = match &self.programs {
            Programs::None => Vec::new(),
            Programs::OfFrame(programs) => programs(variant),
            Programs::OfScene(programs) => {
                let unlike: HashSet<_> = scenes.iter().collect();
                unlike.into_iter().flat_map(programs).collect()
            }
        };
        let seen_by = |resource: Resource| {
            let modules = programs.iter().flat_map(|program| program.modules());
            let is_seen =
                |module: &Module| module.resources.iter().any(|(declared, _)| resource.is_seen_as(declared));
            modules
                .filter(|module| is_seen(module))
                .fold(ShaderStageFlags::empty(), |all, module| all | module.stage)
        };
        let read = self.reads.iter().map(|resource| (*resource, false));
        let all = read.chain(self.writes.iter().map(|resource| (*resource, true)));
        let touched = all.map(|(resource, write)| (resource, seen_by(resource), write));
        let touched = touched.filter(|(_, stages, _)| !stages.is_empty());
        let mut list: Vec<_> =
            touched.map(|(resource, stages, write)| (resource, Access::of_shader(stages, write))).collect();
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
    fn what_is_numbered_by_one_coordinate_is_in_one_row() {
        // As many as 65,535 workgroups have.
        assert_eq!(row_over(4_194_240), [65_535, 1, 1]);
        let [x, y, _] = grid_over(4_194_240);
        assert!(y > 1 && u64::from(x) * u64::from(y) * WORKGROUP >= 4_194_240);
    }
}
