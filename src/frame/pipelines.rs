//! Pipelines of passes, created on first use of a variant, several at a time, and cached.

use super::methods::{Path, passes};
use super::pass::{Commands, Pass, Program, Programs, Stages};
use super::recording::{Pipeline, Pipelines as PassPipelines};
use super::scene_variant::SceneVariant;
use super::variant::Variant;
use super::{pyramids, target_descriptions};
use crate::error::Result;
use crate::vk::shaders;
use crate::vk::{
    Code, ComputePipeline, Constants, DepthTest, Device, DrawPipeline, DrawState, RenderPass, SetLayout,
    Within,
};
use std::collections::{HashMap, HashSet};
use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Pipeline cache of a renderer.
pub struct Pipelines {
    made: HashMap<Key, PassPipelines>,
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

/// A request for pipelines of a pass.
#[derive(Clone, Copy)]
struct Request {
    pass: &'static Pass,
    over: Over,
}

/// What pipelines of a pass run over, with what they depend on.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Over {
    Frame(Variant),
    Scene(SceneVariant),
}

type Key = (usize, Over);

impl Request {
    /// Requests for all pipelines of a pass: one set for the frame, or one per scene.
    fn of(pass: &'static Pass, variant: &Variant, scenes: &[SceneVariant]) -> Vec<Self> {
        match pass.programs {
            Programs::OfFrame(_) => vec![Self { pass, over: Over::Frame(*variant) }],
            Programs::OfScene(_) => {
                scenes.iter().map(|scene| Self { pass, over: Over::Scene(*scene) }).collect()
            }
        }
    }

    fn key(&self) -> Key {
        (key(self.pass), self.over)
    }
}

/// Stack of a thread that compiles, bytes: as much as drivers have on main threads.
const STACK: usize = 8 << 20;

/// Most threads that compile at once: compilers of drivers take much memory.
const MOST_THREADS: usize = 8;

/// The results of `make` for 0, 1, … below `count`, by as many threads as the CPU runs at once, at most [`MOST_THREADS`]. They are no threads of
/// a pool, which would do other work of the host while they wait for each other.
fn in_parallel<T: Send>(count: usize, make: &(dyn Fn(usize) -> T + Sync)) -> Vec<T> {
    let next = AtomicUsize::new(0);
    let take = || {
        let numbers = std::iter::repeat_with(|| next.fetch_add(1, Ordering::Relaxed));
        numbers.take_while(|i| *i < count).map(|i| (i, make(i))).collect::<Vec<_>>()
    };
    let threads = std::thread::available_parallelism().map_or(1, usize::from).min(MOST_THREADS).min(count);
    let mut made = std::thread::scope(|scope| {
        let start = |_| std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, take).ok();
        let others: Vec<_> = (1..threads).filter_map(start).collect();
        let mut made = take();
        for other in others {
            made.extend(other.join().unwrap_or_else(|panic| resume_unwind(panic)));
        }
        made
    });
    made.sort_unstable_by_key(|(i, _)| *i);
    made.into_iter().map(|(_, result)| result).collect()
}

impl Pipelines {
    /// An empty cache; with `host`, raster passes are drawn in its subpasses.
    pub fn new(host: Option<Host>) -> Self {
        Self { made: HashMap::new(), render_passes: HashMap::new(), host }
    }

    /// The passes of a frame of `variant`.
    pub fn passes(&self, variant: &Variant) -> Vec<&'static Pass> {
        let Some(host) = &self.host else { return passes(variant, Path::of(variant)) };
        let seed = host.draws.iter().any(|draw| draw.pass.name == "seed");
        passes(variant, Path::Subpasses { seed })
    }

    /// Whether raster passes are drawn in subpasses of a host.
    pub fn has_host(&self) -> bool {
        self.host.is_some()
    }

    /// Whether a pass is drawn in a subpass of the host.
    pub fn is_host_pass(&self, pass: &'static Pass) -> bool {
        self.host.as_ref().is_some_and(|host| host.draws.iter().any(|draw| std::ptr::eq(draw.pass, pass)))
    }

    /// The pipelines of each of the passes of a frame: one set for the frame, or one per scene. Missing ones are compiled in parallel.
    pub fn for_passes(
        &mut self,
        device: &Arc<Device>,
        list: &[&'static Pass],
        variant: &Variant,
        scenes: &[SceneVariant],
    ) -> Result<Vec<Vec<PassPipelines>>> {
        let requests: Vec<_> = list.iter().map(|pass| Request::of(pass, variant, scenes)).collect();
        let missing = self.missing(requests.iter().flatten());
        for request in &missing {
            self.render_pass(device, request.pass, variant)?;
        }
        let made = in_parallel(missing.len(), &|i| self.make(device, &missing[i], variant));
        for (request, made) in missing.iter().zip(made) {
            self.made.insert(request.key(), made?);
        }
        let pipelines = |request: &Request| self.made[&request.key()].clone();
        Ok(requests.iter().map(|of_pass| of_pass.iter().map(pipelines).collect()).collect())
    }

    /// The requests for pipelines that do not exist yet, each once. Passes of one name share pipelines, which one thread would wait for while
    /// another creates them: the first of each name comes first.
    fn missing<'a>(&self, requests: impl Iterator<Item = &'a Request>) -> Vec<Request> {
        let (mut keys, mut names) = (HashSet::new(), HashSet::new());
        let missing = requests.filter(|request| !self.made.contains_key(&request.key()));
        let (mut first, others): (Vec<_>, Vec<_>) = missing
            .filter(|request| keys.insert(request.key()))
            .partition(|request| names.insert(request.pass.name));
        first.extend(others);
        first
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

    /// Creates pipelines of a pass, whose render pass exists.
    fn make(&self, device: &Arc<Device>, request: &Request, variant: &Variant) -> Result<PassPipelines> {
        let (pass, over) = (request.pass, &request.over);
        let (programs, constants) = match (&pass.programs, over) {
            (Programs::OfScene(programs), Over::Scene(scene)) => (programs(scene), scene.constants()),
            (Programs::OfFrame(programs), _) => (programs(variant), variant.constants()),
            // `Request::of` makes no such pair.
            (Programs::OfScene(_), Over::Frame(_)) => return Ok(PassPipelines::default()),
        };
        let first_set = |program: &Program| match over {
            Over::Frame(variant) => variant.view_resources(),
            Over::Scene(scene) => scene.resources(program.domain.scope()),
        };
        let render_pass = self.render_passes.get(&(key(pass), *variant));
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
                Stages::Draw(modules) => match (render_pass, &pass.commands) {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_of_threads_are_in_order() {
        assert!(in_parallel(0, &|i| i).is_empty());
        let slow_at_first = |i: usize| {
            std::thread::sleep(std::time::Duration::from_millis(20 - 2 * i as u64));
            10 * i
        };
        assert_eq!(in_parallel(9, &slow_at_first), [0, 10, 20, 30, 40, 50, 60, 70, 80]);
    }

    #[test]
    #[should_panic(expected = "of 3")]
    fn a_panic_is_that_of_the_thread() {
        in_parallel(8, &|i| assert_ne!(i, 3, "of {i}"));
    }
}
