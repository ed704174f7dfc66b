//! The pipelines of passes, made as variants come up, and kept.

use super::methods::{Path, passes};
use super::pass::{Commands, Pass, Program, Programs, Stages};
use super::recording::{Pipeline, Pipelines as OfPass};
use super::variant::{SceneVariant, Variant};
use super::{pyramids, targets};
use crate::error::Result;
use crate::vk::shaders;
use crate::vk::{
    Code, ComputePipeline, Constants, DepthTest, Device, DrawPipeline, DrawState, RenderPass, SetLayout,
    Within,
};
use std::collections::HashMap;
use std::sync::Arc;

/// The pipelines of a renderer.
pub struct Pipelines {
    of_frames: HashMap<(usize, Variant), OfPass>,
    of_scenes: HashMap<(usize, SceneVariant), OfPass>,
    render_passes: HashMap<(usize, Variant), Arc<RenderPass>>,
    host: Option<Host>,
}

/// Where a host has passes drawn: in subpasses of its own.
pub struct Host {
    /// The passes with their subpasses.
    pub draws: Vec<HostDraw>,
    /// What shaders see at descriptor set 1, beside coverage.
    pub resources: Vec<&'static shaders::Resource>,
}

/// A pass in a subpass of a host.
pub struct HostDraw {
    pub pass: &'static Pass,
    pub within: Within,
    pub depth: DepthTest,
    /// Specialization constants beside those of the frame.
    pub constants: Constants,
    /// The fragment shader, where it is another.
    pub fragment: Option<&'static shaders::Module>,
}

/// What tells passes apart.
fn key(pass: &'static Pass) -> usize {
    std::ptr::from_ref(pass).addr()
}

impl Pipelines {
    /// None yet; of a host, if one is given.
    pub fn new(host: Option<Host>) -> Self {
        Self { of_frames: HashMap::new(), of_scenes: HashMap::new(), render_passes: HashMap::new(), host }
    }

    /// The passes of a frame of `variant`, of so many scenes.
    pub fn passes(&self, variant: &Variant, scenes: usize) -> Vec<&'static Pass> {
        let Some(host) = &self.host else { return passes(variant, Path::of(variant), scenes) };
        let seed = host.draws.iter().any(|draw| draw.pass.name == "seed");
        passes(variant, Path::Subpasses { seed }, scenes)
    }

    /// Whether what is drawn is drawn in subpasses of a host.
    pub fn has_host(&self) -> bool {
        self.host.is_some()
    }

    /// Whether a pass is drawn in a subpass of the host.
    pub fn is_of_host(&self, pass: &'static Pass) -> bool {
        self.host.as_ref().is_some_and(|host| host.draws.iter().any(|draw| std::ptr::eq(draw.pass, pass)))
    }

    /// The pipelines of a pass, those of the frame or of each scene, and how it touches what it reads and writes.
    pub fn of(
        &mut self,
        device: &Arc<Device>,
        pass: &'static Pass,
        variant: &Variant,
        scenes: &[SceneVariant],
    ) -> Result<Vec<OfPass>> {
        match pass.programs {
            Programs::None => Ok(Vec::new()),
            Programs::OfFrame(programs) => {
                if let Some(made) = self.of_frames.get(&(key(pass), *variant)) {
                    return Ok(vec![made.clone()]);
                }
                let view = |_: &Program| variant.view_resources();
                let made =
                    self.make(device, pass, programs(variant), variant, &variant.constants(), &view)?;
                self.of_frames.insert((key(pass), *variant), made.clone());
                Ok(vec![made])
            }
            Programs::OfScene(programs) => {
                let mut all = Vec::with_capacity(scenes.len());
                for scene in scenes {
                    let made = match self.of_scenes.get(&(key(pass), *scene)) {
                        Some(made) => made.clone(),
                        None => {
                            let own = |program: &Program| scene.resources(program.over.scope());
                            let constants = scene.constants();
                            let made = self.make(device, pass, programs(scene), variant, &constants, &own)?;
                            self.of_scenes.insert((key(pass), *scene), made.clone());
                            made
                        }
                    };
                    all.push(made);
                }
                Ok(all)
            }
        }
    }

    /// What a pass draws to, unless that is a host's.
    pub fn render_pass(
        &mut self,
        device: &Arc<Device>,
        pass: &'static Pass,
        variant: &Variant,
    ) -> Result<Option<Arc<RenderPass>>> {
        let Commands::Draws(targets) = &pass.commands else { return Ok(None) };
        if self.is_of_host(pass) {
            return Ok(None);
        }
        if let Some(made) = self.render_passes.get(&(key(pass), *variant)) {
            return Ok(Some(made.clone()));
        }
        let (colours, depth) = targets.attachments(variant);
        let made = Arc::new(RenderPass::new(device, &colours, depth)?);
        self.render_passes.insert((key(pass), *variant), made.clone());
        Ok(Some(made))
    }

    fn make(
        &mut self,
        device: &Arc<Device>,
        pass: &'static Pass,
        programs: Vec<Program>,
        variant: &Variant,
        constants: &Constants,
        first_set: &dyn Fn(&Program) -> Vec<&'static shaders::Resource>,
    ) -> Result<OfPass> {
        let render_pass = self.render_pass(device, pass, variant)?;
        let mut made = Vec::with_capacity(programs.len());
        for program in programs {
            let layouts = self.layouts(device, pass, &program, variant, first_set(&program))?;
            let sets: Vec<&SetLayout> = layouts.iter().map(Arc::as_ref).collect();
            let constants = constants.clone().and(&program.constants);
            let pipeline = match program.stages {
                Stages::Compute(module) => {
                    Pipeline::Compute(ComputePipeline::new(device, &sets, module, &constants)?)
                }
                Stages::Draw(modules) => Pipeline::Draw(match (&render_pass, &pass.commands) {
                    (Some(into), Commands::Draws(targets)) => {
                        let (topology, depth, blend) = (targets.topology, targets.test, targets.blend);
                        let state = DrawState { topology, depth, blend };
                        DrawPipeline::new(device, &sets, modules, &constants, into, state)?
                    }
                    _ => match self.draw_of_host(device, pass, &sets, modules, &constants)? {
                        Some(pipeline) => pipeline,
                        None => continue,
                    },
                }),
            };
            made.push((program.over, pipeline));
        }
        Ok(Arc::new(made))
    }

    fn draw_of_host(
        &self,
        device: &Arc<Device>,
        pass: &'static Pass,
        sets: &[&SetLayout],
        [vertex, fragment]: [&'static shaders::Module; 2],
        constants: &Constants,
    ) -> Result<Option<DrawPipeline>> {
        let mut draws = self.host.iter().flat_map(|host| &host.draws);
        let Some(draw) = draws.find(|draw| std::ptr::eq(draw.pass, pass)) else { return Ok(None) };
        let code = [vertex, draw.fragment.unwrap_or(fragment)].map(Code::from);
        let constants = constants.clone().and(&draw.constants);
        DrawPipeline::of_host(device, sets, code, &constants, &draw.within, draw.depth).map(Some)
    }

    /// Layouts of the descriptor sets 0, 1, … that a program sees: of all scenes or one, of the targets, of counts or the pyramid that it
    /// writes, and of the one that it reads.
    fn layouts(
        &self,
        device: &Arc<Device>,
        pass: &Pass,
        program: &Program,
        variant: &Variant,
        first: Vec<&'static shaders::Resource>,
    ) -> Result<Vec<Arc<SetLayout>>> {
        let seen =
            || program.modules().iter().flat_map(|module| module.resources).map(|(resource, _)| *resource);
        // What is not counted is in no set of its own.
        let seen_and_there = seen().filter(|seen| variant.count || *seen != &shaders::resource::COUNTS);
        let count = seen_and_there.map(|resource| resource.set + 1).max().unwrap_or_default();
        let resources = |set| match set {
            2 if seen().any(|seen| seen == &shaders::resource::COUNTS) => vec![&shaders::resource::COUNTS],
            0 => first.clone(),
            1 => match &self.host {
                Some(host) => {
                    let coverage = variant.coverage.then_some(&shaders::resource::COVERAGE);
                    host.resources.iter().copied().chain(coverage).collect()
                }
                None => targets::shader_resources(variant),
            },
            _ => pyramids::shader_resources(variant),
        };
        let resources = |set| {
            let mut list = resources(set);
            list.retain(|resource| set != 1 || pass.sees(resource));
            list
        };
        (0..count).map(|set| SetLayout::of(device, resources(set))).collect()
    }
}
