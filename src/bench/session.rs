//! One call of the bench: all runs of some suites on one machine.

use super::engine::{Engine, TracedFilter};
use super::plan::Plan;
use super::record::{
    Ceilings, Clock, Gpu, Host, Missing, Provenance, Run, RunSettings, SPLATS, Session, Sweep, Time,
};
use super::runner::{Options, Runner};
use super::suites::{Suite, UserInputs};
use super::time_limit::Estimates;
use super::{ceilings, code, hard, time_limit};
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::settings::{Choice, RasterizerChoice, Settings};
use crate::verify::{baseline, truth};
use crate::vk::Device;
use jiff::Timestamp;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::{Duration, Instant};
use sysinfo::System;

/// Stage of the progress, in runs.
const STAGE: &str = "measuring";

/// Options of a session.
pub struct SessionOptions {
    /// The suites, in this order.
    pub suites: Vec<Suite>,
    /// Inputs of the user, for [`Suite::Inputs`].
    pub inputs: UserInputs,
    /// The device; plans that need one are refused without it.
    pub device: Option<Arc<Device>>,
    /// Choice of the rasterizer of plans that do not name one.
    pub rasterizer: RasterizerChoice,
    /// Whether the validation layers are active.
    pub validated: bool,
    /// Folder that caches exact pictures.
    pub cache: Option<PathBuf>,
    /// Filter of exact pictures.
    pub filter: truth::Filter,
    /// Time for all suites together: see [`time_limit`].
    pub limit: Option<Duration>,
    /// The command that repeats the session.
    pub command: String,
    /// A session of the same options that was interrupted: what it has is not measured again.
    pub earlier: Option<Session>,
}

/// Runs all suites. A run that cannot be rendered is recorded as refused. An error that ends the session, such as a lost device or a
/// cancellation between two groups of runs, is returned beside the results so far. `keep` receives these after every group.
pub fn measure(
    options: SessionOptions,
    progress: &dyn Progress,
    keep: &mut dyn FnMut(&Session) -> Result<()>,
) -> (Session, Result<()>) {
    let (session, start) = (begin(&options), Instant::now());
    let before = session.provenance.seconds;
    let mut plans: Vec<_> = options.suites.iter().map(|suite| suite.plans(&options.inputs)).collect();
    if options.filter == truth::Filter::Box {
        // Ray tracing with the truth's filter is the same.
        plans
            .iter_mut()
            .for_each(|plans| plans.retain(|plan| plan.engine != Engine::Traced(TracedFilter::Box)));
    }
    let total = plans.iter().map(|plans| plans.len() as u64).sum();
    let mut measuring = Measuring { options: &options, progress, keep, session, before, start, total };
    let ended = measuring.all(plans);
    let mut session = measuring.session;
    compare_times(&mut session.runs);
    session.provenance.seconds = before + start.elapsed().as_secs_f64();
    (session, ended)
}

/// The earlier session, to be continued, or a new one.
fn begin(options: &SessionOptions) -> Session {
    if let Some(mut session) = options.earlier.clone() {
        session.provenance.resumed.push(Timestamp::now());
        session.missing.clear();
        return session;
    }
    let provenance = Provenance {
        version: env!("CARGO_PKG_VERSION").into(),
        commit: code::COMMIT.into(),
        code: code::DIGEST.into(),
        date: Timestamp::now(),
        seconds: 0.0,
        resumed: Vec::new(),
        command: options.command.clone(),
        suites: options.suites.iter().map(|suite| suite.name().into()).collect(),
        host: host(),
        device: options.device.as_deref().map(|device| gpu(device, options.validated)),
    };
    Session {
        provenance,
        runs: Vec::new(),
        sweeps: Vec::new(),
        images: Vec::new(),
        ceilings: None,
        missing: Vec::new(),
    }
}

/// A session under way.
struct Measuring<'a> {
    options: &'a SessionOptions,
    progress: &'a dyn Progress,
    keep: &'a mut dyn FnMut(&Session) -> Result<()>,
    session: Session,
    /// Duration before an interruption, seconds.
    before: f64,
    start: Instant,
    /// Number of runs of all suites.
    total: u64,
}

impl Measuring<'_> {
    /// Measures the plans of each suite, then the hard cases.
    fn all(&mut self, plans: Vec<Vec<Plan>>) -> Result<()> {
        let suites = &self.options.suites;
        let end = self.options.limit.map(|limit| self.start + limit);
        self.progress.at(STAGE, self.session.runs.len() as u64, self.total);
        if suites.contains(&Suite::Scaling) && self.session.ceilings.is_none() {
            self.session.ceilings = ceilings(self.options);
        }
        for (index, (suite, plans)) in suites.iter().zip(plans).enumerate() {
            // The hard cases are last.
            let left = suites.len() - index + usize::from(suites[..index].contains(&Suite::Hard));
            self.suite(*suite, plans, time_limit::end_of_suite(end, left))?;
        }
        self.progress.at(STAGE, self.total, self.total);
        if suites.contains(&Suite::Hard) && self.session.sweeps.is_empty() {
            let (sweeps, missing) = hard(self.options, end, self.progress)?;
            self.session.sweeps = sweeps;
            self.session.missing.extend(missing);
        }
        Ok(())
    }

    /// Measures the groups of a suite that are not in the session.
    fn suite(&mut self, suite: Suite, plans: Vec<Plan>, until: Option<Instant>) -> Result<()> {
        let SessionOptions { device, rasterizer, cache, inputs, filter, .. } = self.options;
        let of_suite = Options {
            device: device.clone(),
            rasterizer: *rasterizer,
            cache: cache.clone(),
            truth: truth::Options { filter: *filter, ..time_limit::truth(suite, until) },
            effort: time_limit::effort(suite.effort(), plans.len(), until),
            until,
        };
        let mut runner = Runner::new(of_suite, inputs.all().collect());
        let mut estimates = Estimates::default();
        for plans in time_limit::groups(plans, until.is_some()) {
            if self.has(&plans) {
                continue;
            }
            if self.progress.is_cancelled() {
                return Err(Error::Cancelled);
            }
            if !estimates.fit(&plans, until) {
                self.session.missing.extend(time_limit::missing(&plans));
                continue;
            }
            let begin = Instant::now();
            self.group(&mut runner, &plans)?;
            estimates.add(plans, begin.elapsed());
        }
        Ok(())
    }

    /// Whether all runs of a group are in the session.
    fn has(&self, plans: &[Plan]) -> bool {
        plans.iter().all(|plan| self.session.runs.iter().any(|run| plan.is_done_by(run)))
    }

    /// Measures a group.
    fn group(&mut self, runner: &mut Runner, plans: &[Plan]) -> Result<()> {
        let (begin, first, before) = (Instant::now(), self.session.runs.len(), self.session.images.len());
        let Self { session, progress, total, .. } = self;
        let measured = runner.run_together(plans, &mut |mut run| {
            run.images.iter_mut().for_each(|index| *index += before);
            session.runs.push(run);
            progress.at(STAGE, session.runs.len() as u64, *total);
        });
        session.images.extend(runner.take_images());
        measured?;
        session.missing.extend(time_limit::missing(&plans[session.runs.len() - first..]));
        session.provenance.seconds = self.before + self.start.elapsed().as_secs_f64();
        let Plan { scene, points, experiment, .. } = &plans[0];
        log::info!("{scene} {points} {experiment:?}: {} runs in {:.2?}", plans.len(), begin.elapsed());
        (self.keep)(&self.session)
    }
}

/// Rates of the device; none, with a warning, if they cannot be measured.
fn ceilings(options: &SessionOptions) -> Option<Ceilings> {
    let device = options.device.as_ref()?;
    let measured = ceilings::measure(device, &ceilings::Sizes::of(device));
    measured.map_err(|error| log::warn!("no shares of the device's rates: {error}")).ok()
}

fn hard(
    options: &SessionOptions,
    until: Option<Instant>,
    progress: &dyn Progress,
) -> Result<(Vec<Sweep>, Vec<Missing>)> {
    let none = || Error::NoDevice("the hard cases need one; list devices with `surfel devices`".into());
    let cases = hard::Options { until, ..Default::default() };
    let sweeps = hard::run(options.device.as_ref().ok_or_else(none)?, &cases, progress)?;
    let missing = hard::missing(&cases, &sweeps);
    Ok((sweeps, missing))
}

/// Computes times relative to the CPU baseline for as many points and the same picture with its own settings. Of several
/// baselines, one of the same suite and experiment is preferred, as it ran at about the same time.
fn compare_times(runs: &mut [Run]) {
    let shipped = |run: &&Run| {
        let RunSettings { cutoff, lowpass, pixel_filter, widen, epsilon, cull, alpha, edges, .. } =
            RunSettings::of(&baseline::settings(&Settings::default()));
        let own = &run.settings;
        (own.cutoff, own.lowpass, own.epsilon) == (cutoff, lowpass, epsilon)
            && own.pixel_filter == pixel_filter
            && own.widen == widen
            && own.cull == cull
            && own.alpha == alpha
            && own.edges == edges
    };
    let baselines = runs.iter().filter(|run| run.implementation.method == SPLATS).filter(shipped);
    let baselines: Vec<Run> = baselines.filter(|run| run.ms().is_some()).cloned().collect();
    for run in runs {
        let alike = baselines.iter().filter(|other| {
            let of = |run: &Run| (run.points, run.overlap);
            run.view() == other.view() && of(run) == of(other)
        });
        let distance = |other: &Run| (run.suite != other.suite, run.experiment != other.experiment);
        let unit = alike.min_by_key(|other| distance(other)).and_then(|other| other.time.as_ref());
        if let (Some(time), Some(unit)) = (&mut run.time, unit) {
            let of =
                |time: &Time, clock| if clock == Clock::Cpu { time.cpu.median } else { time.wall.median };
            time.baseline_ratio = Some(of(time, time.clock) / of(unit, time.clock));
        }
    }
}

fn host() -> Host {
    let system = System::new_all().ok();
    let cpu = system.as_ref().and_then(|system| Some(system.cpus().first()?.brand().trim().to_owned()));
    Host {
        cpu: cpu.unwrap_or_default(),
        cores: std::thread::available_parallelism().map_or(1, usize::from),
        memory: system.map_or(0, |system| system.total_memory()),
        system: System::long_os_version().unwrap_or_default(),
    }
}

fn gpu(device: &Device, validated: bool) -> Gpu {
    let description = device.description();
    Gpu {
        name: description.name.clone(),
        driver: description.driver.clone(),
        kind: description.kind.into(),
        validated,
    }
}
