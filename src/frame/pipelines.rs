//! Pipelines of passes, created on first use of a variant and cached.

use super::methods::{Path, passes};
use super::pass::{Commands, Pass, Program, Programs, Stages};
use super::recording::{Pipeline, Pipelines as PassPipelines};
use super::variant::{SceneVariant, Variant};
use super::{pyramids, target_descriptions};
use crate::error::Result;
use crate::vk::shaders;
use crate::vk::{
    Code, ComputePipeline, Constants, DepthTest, Device, DrawPipeline, DrawState, RenderPass, SetLayout,
    Within,
};
use std::collections::HashMap;
use std::sync::Arc;

/// Pipeline cache of a renderer.
pub struct Pipelines {
    frame_pipelines: HashMap<(usize, Variant), PassPipelines>,
    scene_pipelines: HashMap<(usize, SceneVariant), PassPipelines>,
    render_passes: HashMap<(usize, Variant), Arc<RenderPass>>,
    host: Option<Host>,
}

/// Subpasses of a host in which raster passes are drawn.
pub struct Host {
    /// The passes with their subpasses. A pass may have several draws.
    pub draws: Vec<HostDraw>,
    /// Resources of descriptor set 1, without coverage.
    pub resources: Vec<&'static shaders::Resource>,
}

/// A pass in a subpass of a host.
pub struct HostDraw {
    pub pass: &'static Pass,
    pub within: Within,
    pub depth: DepthTest,
    /// Specialization constants in addition to those of the frame.
    pub constants: Constants,
    /// Replacement of the fragment shader.
    pub fragment: Option<&'static shaders::Module>,
    /// Only frames of which α is coverage have it.
    pub is_of_coverage: bool,
}

/// Identity of a pass, as a map key.
fn key(pass: &'static Pass) -> usize {
    std::ptr::from_ref(pass).addr()
}

impl Pipelines {
    /// An empty cache; with `host`, raster passes are drawn in its subpasses.
    pub fn new(host: Option<Host>) -> Self {
        Self {
            frame_pipelines: HashMap::new(),
            scene_pipelines: HashMap::new(),
            render_passes: HashMap::new(),
            host,
        }
    }

    /// The passes of a frame of `variant` with so many scenes.
    pub fn passes(&self, variant: &Variant, scenes: usize) -> Vec<&'static Pass> {
        let Some(host) = &self.host else { return passes(variant, Path::of(variant), scenes) };
        let seed = host.draws.iter().any(|draw| draw.pass.name == "seed");
        passes(variant, Path::Subpasses { seed }, scenes)
    }

    /// Whether raster passes are drawn in subpasses of a host.
    pub fn has_host(&self) -> bool {
        self.host.is_some()
    }

    /// Whether a pass is drawn in a subpass of the host.
    pub fn is_host_pass(&self, pass: &'static Pass) -> bool {
        self.host.as_ref().is_some_and(|host| host.draws.iter().any(|draw| std::ptr::eq(draw.pass, pass)))
    }

    /// The pipelines of a pass: one set for the frame, or one per scene.
    pub fn for_pass(
        &mut self,
        device: &Arc<Device>,
        pass: &'static Pass,
        variant: &Variant,
        scenes: &[SceneVariant],
    ) -> Result<Vec<PassPipelines>> {
        match pass.programs {
            Programs::OfFrame(programs) => {
                if let Some(pipelines) = self.frame_pipelines.get(&(key(pass), *variant)) {
                    return Ok(vec![pipelines.clone()]);
                }
                let view = |_: &Program| variant.view_resources();
                let pipelines =
                    self.make(device, pass, programs(variant), variant, &variant.constants(), &view)?;
                self.frame_pipelines.insert((key(pass), *variant), pipelines.clone());
                Ok(vec![pipelines])
            }
            Programs::OfScene(programs) => {
                let mut all = Vec::with_capacity(scenes.len());
                for scene in scenes {
                    let pipelines = match self.scene_pipelines.get(&(key(pass), *scene)) {
                        Some(pipelines) => pipelines.clone(),
                        None => {
                            let resources = |program: &Program| scene.resources(program.domain.scope());
                            let constants = scene.constants();
                            let pipelines =
                                self.make(device, pass, programs(scene), variant, &constants, &resources)?;
                            self.scene_pipelines.insert((key(pass), *scene), pipelines.clone());
                            pipelines
                        }
                    };
                    all.push(pipelines);
                }
                Ok(all)
            }
        }
    }

    /// The render pass of a raster pass; `None` in subpasses of a host.
    pub fn render_pass(
        &mut self,
        device: &Arc<Device>,
        pass: &'static Pass,
        variant: &Variant,
    ) -> Result<Option<Arc<RenderPass>>> {
        let Commands::Draws(targets) = &pass.commands else { return Ok(None) };
        if self.is_host_pass(pass) {
            return Ok(None);
        }
        if let Some(render_pass) = self.render_passes.get(&(key(pass), *variant)) {
            return Ok(Some(render_pass.clone()));
        }
        let (colours, depth) = targets.attachments(variant);
        let render_pass = Arc::new(RenderPass::new(device, &colours, depth)?);
        self.render_passes.insert((key(pass), *variant), render_pass.clone());
        Ok(Some(render_pass))
    }

    fn make(
        &mut self,
        device: &Arc<Device>,
        pass: &'static Pass,
        programs: Vec<Program>,
        variant: &Variant,
        constants: &Constants,
        first_set: &dyn Fn(&Program) -> Vec<&'static shaders::Resource>,
    ) -> Result<PassPipelines> {
        let render_pass = self.render_pass(device, pass, variant)?;
        let mut pipelines = Vec::with_capacity(programs.len());
        for program in programs {
            let layouts = self.layouts(device, pass, &program, variant, first_set(&program))?;
            let sets: Vec<&SetLayout> = layouts.iter().map(Arc::as_ref).collect();
            let constants = constants.clone().and(&program.constants);
            let created = match program.stages {
                Stages::Compute(module) => vec![Pipeline::Compute(ComputePipeline::new(
                    device,
                    &sets,
                    module,
                    &constants,
                    program.is_subgroup,
                )?)],
                Stages::Draw(modules) => match (&render_pass, &pass.commands) {
                    (Some(into), Commands::Draws(targets)) => {
                        let (topology, depth, blend) = (targets.topology, targets.test, targets.blend);
                        let state = DrawState { topology, depth, blend };
                        let pipeline = DrawPipeline::new(device, &sets, modules, &constants, into, state)?;
                        vec![Pipeline::Draw(pipeline)]
                    }
                    _ => self.host_pipelines(device, (pass, variant), &sets, modules, &constants)?,
                },
            };
            pipelines.extend(created.into_iter().map(|pipeline| (program.domain, pipeline)));
        }
        Ok(Arc::new(pipelines))
    }

    /// The pipelines of a pass's draws in a subpass of the host.
    fn host_pipelines(
        &self,
        device: &Arc<Device>,
        (pass, variant): (&'static Pass, &Variant),
        sets: &[&SetLayout],
        [vertex, fragment]: [&'static shaders::Module; 2],
        constants: &Constants,
    ) -> Result<Vec<Pipeline>> {
        let draws = self.host.iter().flat_map(|host| &host.draws);
        let drawn =
            |draw: &&HostDraw| std::ptr::eq(draw.pass, pass) && (variant.coverage || !draw.is_of_coverage);
        let pipeline = |draw: &HostDraw| {
            let code = [vertex, draw.fragment.unwrap_or(fragment)].map(Code::from);
            let constants = constants.clone().and(&draw.constants);
            let made = DrawPipeline::of_host(device, sets, code, &constants, &draw.within, draw.depth);
            made.map(Pipeline::Draw)
        };
        draws.filter(drawn).map(pipeline).collect()
    }

    /// Layouts of descriptor sets 0, 1, … of a program: frame or scene; targets; counts, or the pyramid that is written, or the final one
    /// that shade reads; and the pyramid that is read.
    fn layouts(
        &self,
        device: &Arc<Device>,
        pass: &Pass,
        program: &Program,
        variant: &Variant,
        first: Vec<&'static shaders::Resource>,
    ) -> Result<Vec<Arc<SetLayout>>> {
        let declared =
            || program.modules().iter().flat_map(|module| module.resources).map(|(resource, _)| *resource);
        // Frames without counts have no set for them.
        let bound = declared().filter(|resource| variant.count || *resource != &shaders::resource::COUNTS);
        let count = bound.map(|resource| resource.set + 1).max().unwrap_or_default();
        let resources = |set| match set {
            2 if declared().any(|resource| resource == &shaders::resource::COUNTS) => {
                vec![&shaders::resource::COUNTS]
            }
            0 => first.clone(),
            1 => match &self.host {
                Some(host) => {
                    let coverage = variant.coverage.then_some(&shaders::resource::COVERAGE);
                    host.resources.iter().copied().chain(coverage).collect()
                }
                None => target_descriptions::shader_resources(variant),
            },
            _ => {
                let written = declared().any(|resource| resource == &shaders::resource::TO_IMAGE0);
                pyramids::shader_resources(variant, set == 2 && written)
            }
        };
        let resources = |set| {
            let mut list = resources(set);
            list.retain(|resource| set != 1 || pass.binds(resource));
            list
        };
        (0..count).map(|set| SetLayout::of(device, resources(set))).collect()
    }
}
