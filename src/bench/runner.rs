//! Executes plans, and caches what several runs share: surfels, exact pictures, the device.

mod octrees;
mod truths;

use super::engine::{CpuEngine, DeviceEngine, Engine, LoadedEngine, TracedEngine, TracedFilter};
use super::papers::details;
use super::plan::{Measurements, Plan};
use super::record::{self, Against, Clock, Float64Error, Images, Run, RunSettings, Time};
use super::stopwatch::Effort;
use super::subject::{Subject, pixel_angle};
use super::{error_terms, frame_times, hidden, images, work};
use crate::capture::{self, capture};
use crate::error::{Error, Result};
use crate::frame::times::Statistics;
use crate::geometry::{Camera, Levels, Model, Surfels};
use crate::picture::Picture;
use crate::settings::splatting::Normalization;
use crate::settings::{Choice, Hierarchy, RasterizerChoice, Settings, Shading};
use crate::verify::metrics::flicker::Flicker;
use crate::verify::metrics::path::PathValues;
use crate::verify::metrics::{self, Pair, colour};
use crate::verify::reference::{self, Expected, Tolerance};
use crate::verify::scenes::Viewpoint;
use crate::verify::truth::{self, Filter, Truth};
use crate::vk::Device;
use crate::{RenderOptions, Scene};
use octrees::Octrees;
use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

/// Frames of the camera path for flicker.
const PATH: u32 = 6;

/// Shift of the picture from one of these frames to the next, px: below one half, and no simple fraction.
pub const STEP: f64 = 0.37;

/// Options of a runner.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The device; plans that need one are refused without it.
    pub device: Option<Arc<Device>>,
    /// Choice of the rasterizer of plans that do not name one.
    pub rasterizer: RasterizerChoice,
    /// Folder that caches exact pictures.
    pub cache: Option<PathBuf>,
    /// Precision of exact pictures.
    pub truth: truth::Options,
    /// Number of timed frames.
    pub effort: Effort,
    /// Time after which no further plan is measured.
    pub until: Option<Instant>,
}

/// Executes plans one by one; fastest if plans of one scene follow each other.
pub struct Runner {
    options: Options,
    /// Scans; plans refer to them by name.
    scans: Vec<Rc<Subject>>,
    subject: Option<Rc<Subject>>,
    model: Option<(ModelKey, Rc<Model>)>,
    /// The uploaded model, and whether with levels of detail.
    scene: Option<(Rc<Model>, bool, Rc<Scene>)>,
    octrees: Octrees,
    truths: HashMap<String, Rc<Truth>>,
    images: Vec<Images>,
}

/// Key of a cached model.
#[derive(Clone, Debug, PartialEq)]
struct ModelKey {
    scene: String,
    points: u64,
    radius_scale: f32,
    /// Settings of the captured normalization weights, if there are any.
    weights: Option<Settings>,
}

/// Memory of the engines that take turns, about.
const MOST_BYTES: u64 = 2 << 30;

/// A job with its loaded engine.
struct Opened<'a> {
    job: Job<'a>,
    engine: Box<dyn LoadedEngine>,
}

impl Opened<'_> {
    fn side(&mut self) -> frame_times::Side<'_> {
        (&mut *self.engine, &self.job.camera, &self.job.plan.settings)
    }
}

/// A plan with its model and camera.
struct Job<'a> {
    plan: &'a Plan,
    subject: Rc<Subject>,
    /// The model, or what is selected of its octree.
    model: Rc<Model>,
    /// Points of the model.
    points: u64,
    octree: Option<record::Octree>,
    viewpoint: Viewpoint,
    camera: Camera,
}

impl Runner {
    /// A runner for plans of these scans and of built-in scenes.
    pub fn new(options: Options, scans: Vec<Rc<Subject>>) -> Self {
        Self {
            options,
            scans,
            subject: None,
            model: None,
            scene: None,
            octrees: Octrees::default(),
            truths: HashMap::new(),
            images: Vec::new(),
        }
    }

    /// Executes a plan; a run that cannot be rendered is returned as refused.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn run(&mut self, plan: &Plan) -> Result<Run> {
        let mut only = None;
        self.run_together(std::slice::from_ref(plan), &mut |run| only = Some(run))?;
        Ok(only.unwrap_or_else(|| blank(plan, None)))
    }

    /// Executes plans that are [beside](Plan::is_beside) each other, and passes each run to `done`, in their order. The frames that are timed take
    /// turns, of as many plans as a limit of memory permits. A run that cannot be rendered is refused. Plans that remain when the
    /// [time](Options::until) is over have no run.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn run_together(&mut self, plans: &[Plan], done: &mut dyn FnMut(Run)) -> Result<()> {
        let fewer = (MOST_BYTES / plans.first().map_or(1, bytes_about)).max(1) as usize;
        for plans in plans.chunks(fewer) {
            if self.is_over() {
                return Ok(());
            }
            let mut opened: Vec<Result<Opened<'_>>> = plans.iter().map(|plan| self.open(plan)).collect();
            let mut times = time_all(&mut opened, &self.options.effort).into_iter();
            let mut runs = Vec::new();
            for (plan, opened) in plans.iter().zip(opened) {
                // Times are measured already.
                if self.is_over() && plan.measurements != Measurements::TIME {
                    break;
                }
                let run = opened.and_then(|opened| {
                    let time = plan.measurements.time.then(|| times.next()).flatten().transpose()?;
                    self.fill(opened, time)
                });
                runs.push(run);
            }
            for (plan, run) in plans.iter().zip(runs) {
                let alone = || self.open(plan).and_then(|opened| self.fill_alone(opened));
                // Another run may have taken the memory.
                let run = if plans.len() > 1 { run.or_else(|error| retried(error, alone)) } else { run };
                match run {
                    Ok(run) => done(run),
                    Err(error) if error.is_device_lost() => return Err(error),
                    Err(error) => {
                        let viewpoint = self.subject(plan).ok().map(|subject| viewpoint(plan, &subject));
                        done(Run { refused: Some(error.to_string()), ..blank(plan, viewpoint) })
                    }
                }
            }
        }
        Ok(())
    }

    /// Whether the time is over.
    fn is_over(&self) -> bool {
        self.options.until.is_some_and(|until| Instant::now() >= until)
    }

    /// The images of the runs since the last call. The indices of the next runs' images begin at 0.
    pub fn take_images(&mut self) -> Vec<Images> {
        std::mem::take(&mut self.images)
    }

    /// The scene or scan of a plan; the last scene is kept.
    fn subject(&mut self, plan: &Plan) -> Result<Rc<Subject>> {
        let known = self.subject.iter().chain(&self.scans).find(|subject| subject.name == plan.scene);
        let subject = match known {
            Some(subject) => subject.clone(),
            None => Rc::new(Subject::scene(&plan.scene)?),
        };
        self.subject = Some(subject.clone());
        Ok(subject)
    }

    fn job<'a>(&mut self, plan: &'a Plan) -> Result<Job<'a>> {
        let subject = self.subject(plan)?;
        let key = self.key(plan);
        let model = match self.model.take() {
            Some((of, model)) if of == key => model,
            _ => Rc::new(self.model(&subject, &key)?),
        };
        self.model = Some((key, model.clone()));
        let viewpoint = viewpoint(plan, &subject);
        let camera = subject.camera(&viewpoint, 0.0, plan.size)?;
        let points = model.surfels.len() as u64;
        let (model, octree) = match plan.hierarchy {
            Hierarchy::Grid => (model, None),
            Hierarchy::Paper => self.octrees.cut(&model, &camera, plan)?,
        };
        Ok(Job { plan, subject, model, points, octree, viewpoint, camera })
    }

    fn model(&self, subject: &Subject, key: &ModelKey) -> Result<Model> {
        let mut model = subject.model(key.points)?;
        let surfels = &mut model.surfels;
        surfels.radii.iter_mut().for_each(|radius| *radius *= key.radius_scale);
        if let Some(settings) = &key.weights {
            let (weights, _) = capture(self.device()?, surfels, settings, capture::VIEWS, &())?;
            surfels.weights = Some(weights);
        }
        Ok(model)
    }

    fn device(&self) -> Result<&Arc<Device>> {
        let none = || Error::NoDevice("this run needs one; list devices with `surfel devices`".into());
        self.options.device.as_ref().ok_or_else(none)
    }

    /// Loads the model of a plan into its engine.
    fn open<'a>(&mut self, plan: &'a Plan) -> Result<Opened<'a>> {
        let job = self.job(plan)?;
        let engine = self.load(&job, &job.model)?;
        Ok(Opened { job, engine })
    }

    /// Times the frames of one engine, and measures the rest.
    fn fill_alone(&mut self, mut opened: Opened<'_>) -> Result<Run> {
        let time = opened.job.plan.measurements.time;
        let mut sides: Vec<_> = time.then(|| opened.side()).into_iter().collect();
        let time = frame_times::time_frames(&mut sides, &self.options.effort).pop().transpose()?;
        self.fill(opened, time)
    }

    /// Measures all but the times.
    fn fill(&mut self, opened: Opened<'_>, time: Option<Time>) -> Result<Run> {
        let Opened { job, mut engine } = opened;
        let (plan, settings) = (job.plan, &job.plan.settings);
        let mut run = Run { time, ..blank(plan, Some(job.viewpoint)) };
        (run.points, run.octree) = (job.points, job.octree);
        run.overlap = job.subject.area().map(|area| overlap(&job.model.surfels, area));
        if let Some(base) = &plan.base {
            let (ratio, clock) = self.ratio(&job, &mut *engine, base)?;
            (run.ratio, run.ratio_clock) = (ratio, Some(clock));
        }
        let measurements = plan.measurements;
        if measurements.error
            || measurements.float64_error
            || measurements.images
            || measurements.terms
            || measurements.details
        {
            let picture = engine.picture(&job.camera, settings)?;
            let expected = self.agree(&job, &picture, &mut run)?;
            if measurements.error {
                run.error = Some(self.error(&job, &picture)?);
            }
            if measurements.details && settings.shading == Shading::Overlap {
                run.blended = details::blended(&picture);
            }
            if measurements.terms {
                self.add_terms(&job, &picture, expected.as_ref(), &mut run)?;
            }
            if measurements.images {
                self.add_images(&job, &picture, &mut run)?;
            }
        }
        if measurements.flicker {
            let (flicker, path) = self.flicker(&job, &mut *engine)?;
            run.error.iter_mut().for_each(|error| {
                error.metrics.insert("flicker".into(), flicker);
                error.path = Some(path.clone());
            });
        }
        run.memory = engine.memory();
        run.time = run.time.or(engine.time_of_picture());
        if run.time.is_some() {
            let drawn = work::drawn(&job.model.surfels, &job.camera, settings);
            run.work = work::of(&engine.traffic(&job.camera, settings), drawn, plan.size);
        }
        Ok(run)
    }

    /// Times frames relative to those of `base`, and by which clock.
    fn ratio(
        &mut self,
        job: &Job<'_>,
        engine: &mut (dyn LoadedEngine + 'static),
        base: &Plan,
    ) -> Result<(Option<Statistics>, Clock)> {
        let other = self.job(base)?;
        let mut others = self.load(&other, &other.model)?;
        let first = (&mut *others, &other.camera, &base.settings);
        let second = (engine, &job.camera, &job.plan.settings);
        frame_times::ratio(first, second, &self.options.effort)
    }

    /// The engine of a job with `model` instead of its own.
    fn load(&mut self, job: &Job<'_>, model: &Rc<Model>) -> Result<Box<dyn LoadedEngine>> {
        let Plan { size, points, .. } = *job.plan;
        match job.plan.engine {
            Engine::Splatting { rasterizer, precision } => {
                let rasterizer = rasterizer.map_or(self.options.rasterizer, RasterizerChoice::Require);
                let of_octree = job.octree.is_some();
                let scene = self.scene(model, !of_octree && job.plan.settings.lod > 0.0)?;
                // Confetti's passes are timed apart.
                let options =
                    RenderOptions { size, rasterizer, precision, split: of_octree, ..Default::default() };
                Ok(Box::new(DeviceEngine::new(self.device()?, scene, options)?))
            }
            Engine::Baseline(kind) => Ok(Box::new(CpuEngine::new(&model.surfels, size, kind)?)),
            Engine::Traced(filter) => {
                let filter = match filter {
                    TracedFilter::Truth => self.options.truth.filter,
                    TracedFilter::Box => Filter::Box,
                };
                Ok(Box::new(TracedEngine::new(&job.subject, points, size, filter)?))
            }
        }
    }

    /// The uploaded model, with levels of detail if asked for; the last one is kept.
    fn scene(&mut self, model: &Rc<Model>, levels: bool) -> Result<Rc<Scene>> {
        let scene = match self.scene.take() {
            Some((of, with, scene)) if Rc::ptr_eq(&of, model) && with == levels => scene,
            _ if levels => Rc::new(Scene::upload(self.device()?, &Levels::of(model.surfels.clone())?)?),
            _ => Rc::new(Scene::upload(self.device()?, &**model)?),
        };
        self.scene = Some((model.clone(), levels, scene.clone()));
        Ok(scene)
    }

    /// Compares the picture with the float64 reference, if the plan asks for it, and returns the reference's picture.
    fn agree(&self, job: &Job<'_>, picture: &Picture, run: &mut Run) -> Result<Option<Picture>> {
        let (plan, model) = (job.plan, &*job.model);
        if plan.measurements.float64_error {
            let tolerance = Tolerance::float32();
            let expected = Expected::new(&model.surfels, &job.camera, plan.size, &plan.settings, &tolerance)?;
            run.float64_error = Some(Float64Error::of(&expected.compare(picture)?));
            return Ok(Some(expected.frame.to_picture()));
        }
        if plan.measurements.terms {
            let frame = reference::render(model, &job.camera, plan.size, &plan.settings, &())?;
            Ok(Some(frame.to_picture()))
        } else {
            Ok(None)
        }
    }

    fn error(&mut self, job: &Job<'_>, picture: &Picture) -> Result<record::Error> {
        let truth = self.truth(job, &job.camera)?;
        let options =
            metrics::Options { object_size: 2.0 * job.subject.bounds().radius, ..Default::default() };
        let pair = Pair::new(picture, &truth.picture)?;
        let measured = metrics::measure(&pair, &options)?;
        let known = measured.values.into_iter().map(|(metric, value)| (metric.name(), value));
        let details = if job.plan.measurements.details { details::of(&pair) } else { Vec::new() };
        let finite = known.chain(details).filter(|(_, value)| value.is_finite());
        Ok(record::Error {
            against: if job.subject.surface().is_some() { Against::Surface } else { Against::OwnReference },
            filter: truths::filter_name(&self.options.truth),
            surface: job.subject.surface_name().into(),
            target: self.options.truth.error,
            most_samples: self.options.truth.most_samples,
            truth_rms: truth.error.rms,
            metrics: finite.map(|(name, value)| (name.into(), value)).collect(),
            terms: error_terms::split(&pair),
            path: None,
        })
    }

    fn add_terms(
        &mut self,
        job: &Job<'_>,
        picture: &Picture,
        expected: Option<&Picture>,
        run: &mut Run,
    ) -> Result<()> {
        let Some(surface) = job.subject.surface() else { return Ok(()) };
        let visible = hidden::visible_surfels(&job.model.surfels, surface, &job.camera);
        let clean = if visible.is_empty() {
            Picture { size: picture.size, colour: vec![[0.0; 4]; picture.colour.len()], ..Default::default() }
        } else {
            let mut engine = self.load(job, &Rc::new(visible.into()))?;
            engine.picture(&job.camera, &job.plan.settings)?
        };
        if let Some(error) = &mut run.error {
            error.terms.hidden = Some(error_terms::distance(picture, &clean));
            error.terms.precision = expected.map(|expected| error_terms::distance(picture, expected));
        }
        Ok(())
    }

    fn add_images(&mut self, job: &Job<'_>, picture: &Picture, run: &mut Run) -> Result<()> {
        let truth = self.truth(job, &job.camera)?;
        self.images.push(images::of(job.plan, picture, &truth.picture)?);
        run.images = Some(self.images.len() - 1);
        Ok(())
    }

    /// The flicker along a slow camera path, and the values of its frames.
    fn flicker(&mut self, job: &Job<'_>, engine: &mut dyn LoadedEngine) -> Result<(f64, PathValues)> {
        let (subject, size) = (&job.subject, job.plan.size);
        let mut flicker = Flicker::new(colour::BLACK);
        for frame in 0..PATH {
            let angle = STEP * pixel_angle(&job.viewpoint, size[1]) * f64::from(frame);
            let camera = subject.camera(&job.viewpoint, angle, size)?;
            let (picture, truth) = (engine.picture(&camera, &job.plan.settings)?, self.truth(job, &camera)?);
            flicker.add(&Pair::new(&picture, &truth.picture)?)?;
        }
        Ok((flicker.value()?, flicker.path().clone()))
    }

    /// Key of a plan's model.
    fn key(&self, plan: &Plan) -> ModelKey {
        let by_surfel = plan.settings.splatting.normalization == Normalization::Surfel;
        let weights = by_surfel.then(|| capture::plain(&plan.settings));
        ModelKey { scene: plan.scene.clone(), points: plan.points, radius_scale: plan.radius_scale, weights }
    }
}

/// Times of all that are opened and ask for them.
fn time_all(opened: &mut [Result<Opened<'_>>], effort: &Effort) -> Vec<Result<Time>> {
    let timed = opened.iter_mut().flatten().filter(|opened| opened.job.plan.measurements.time);
    frame_times::time_frames(&mut timed.map(Opened::side).collect::<Vec<_>>(), effort)
}

/// What another attempt gives, unless the device is lost.
fn retried(error: Error, again: impl FnOnce() -> Result<Run>) -> Result<Run> {
    if error.is_device_lost() { Err(error) } else { again() }
}

/// Bytes that an engine of this plan takes at most, about: pull–push's targets, and splats.
fn bytes_about(plan: &Plan) -> u64 {
    120 * u64::from(plan.size[0]) * u64::from(plan.size[1]) + 100 * plan.points
}

fn viewpoint(plan: &Plan, subject: &Subject) -> Viewpoint {
    plan.place.viewpoint(&subject.viewpoint(), &subject.bounds())
}

/// A run without results.
fn blank(plan: &Plan, from: Option<Viewpoint>) -> Run {
    let viewpoint = from.map(|Viewpoint { eye, target, up, fov_y_deg }| record::Viewpoint {
        place: plan.place.name().into(),
        eye,
        target,
        up,
        fov_y_deg,
    });
    Run {
        suite: plan.suite.into(),
        experiment: plan.experiment,
        paper_item: plan.paper_item.clone(),
        scene: plan.scene.clone(),
        points: plan.points,
        radius_scale: plan.radius_scale,
        size: plan.size,
        viewpoint,
        implementation: plan.implementation(),
        settings: RunSettings::of(&plan.settings),
        refused: None,
        time: None::<Time>,
        ratio: None,
        ratio_clock: None,
        error: None,
        float64_error: None,
        work: Vec::new(),
        memory: Default::default(),
        octree: None,
        overlap: None,
        blended: None,
        images: None,
    }
}

/// Discs over a point of the surface, on average.
fn overlap(surfels: &Surfels, area: f64) -> f64 {
    let disc = |i: usize| {
        let aspect = surfels.ellipses.as_ref().map_or(1.0, |ellipses| f64::from(ellipses[i].aspect));
        std::f64::consts::PI * f64::from(surfels.radii[i]).powi(2) * aspect
    };
    (0..surfels.len()).map(disc).sum::<f64>() / area
}
