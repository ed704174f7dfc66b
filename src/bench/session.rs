//! One call of the bench: all runs of some suites on one machine.

use super::record::{
    Ceilings, Clock, Gpu, Host, Missing, Provenance, Run, RunSettings, SPLATS, Session, Sweep, Time,
};
use super::runner::{Options, Runner};
use super::suites::{Suite, UserInputs};
use super::time_limit::Estimates;
use super::{ceilings, code, hard, time_limit};
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::settings::{Choice, RasterizerChoice};
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
    /// Time for all suites together: see [`time_limit`].
    pub limit: Option<Duration>,
    /// The command that repeats the session.
    pub command: String,
}

/// Runs all suites. A run that cannot be rendered is recorded as refused. An error that ends the session, such as a
/// lost device, is returned beside the results so far.
pub fn measure(options: &SessionOptions, progress: &dyn Progress) -> (Session, Result<()>) {
    let (date, start) = (Timestamp::now(), Instant::now());
    let end = options.limit.map(|limit| start + limit);
    let ceilings = options.suites.contains(&Suite::Scaling).then(|| ceilings(options)).flatten();
    let plans = |suite: &Suite| suite.plans(&options.inputs);
    let total = options.suites.iter().map(|suite| plans(suite).len() as u64).sum();
    let (mut runs, mut images, mut missing) = (Vec::new(), Vec::new(), Vec::new());
    progress.at(STAGE, 0, total);
    let mut ended = options.suites.iter().enumerate().try_for_each(|(index, suite)| {
        // The hard cases are last.
        let left = options.suites.len() - index + usize::from(options.suites[..index].contains(&Suite::Hard));
        let (plans, until) = (plans(suite), time_limit::end_of_suite(end, left));
        let of_suite = Options {
            device: options.device.clone(),
            rasterizer: options.rasterizer,
            cache: options.cache.clone(),
            truth: time_limit::truth(*suite, until),
            effort: time_limit::effort(suite.effort(), plans.len(), until),
            until,
        };
        let (mut runner, before) =
            (Runner::new(of_suite, options.inputs.all().cloned().collect()), images.len());
        let mut estimates = Estimates::default();
        let done = time_limit::groups(plans, until.is_some()).into_iter().try_for_each(|plans| {
            if !estimates.fit(&plans, until) {
                missing.extend(time_limit::missing(&plans));
                return Ok(());
            }
            let (begin, plan, first) = (Instant::now(), &plans[0], runs.len());
            runner.run_together(&plans, &mut |mut run| {
                run.images.iter_mut().for_each(|index| *index += before);
                runs.push(run);
                progress.at(STAGE, runs.len() as u64, total);
            })?;
            missing.extend(time_limit::missing(&plans[runs.len() - first..]));
            let (scene, points, experiment) = (&plan.scene, plan.points, plan.experiment);
            log::info!("{scene} {points} {experiment:?}: {} runs in {:.2?}", plans.len(), begin.elapsed());
            estimates.add(plans, begin.elapsed());
            Ok(())
        });
        images.extend(runner.images());
        done
    });
    progress.at(STAGE, total, total);
    compare_times(&mut runs);
    let mut sweeps = Vec::new();
    if ended.is_ok() && options.suites.contains(&Suite::Hard) {
        match hard(options, end, progress) {
            Ok((swept, late)) => {
                sweeps = swept;
                missing.extend(late);
            }
            Err(error) => ended = Err(error),
        }
    }
    let provenance = Provenance {
        version: env!("CARGO_PKG_VERSION").into(),
        commit: code::COMMIT.into(),
        code: code::DIGEST.into(),
        date,
        seconds: start.elapsed().as_secs_f64(),
        command: options.command.clone(),
        suites: options.suites.iter().map(|suite| suite.name().into()).collect(),
        host: host(),
        device: options.device.as_deref().map(|device| gpu(device, options.validated)),
    };
    (Session { provenance, runs, sweeps, images, ceilings, missing }, ended)
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

/// Computes times relative to the CPU baseline for as many points and pixels with default settings. Of several
/// baselines, one of the same suite and experiment is preferred, as it ran at about the same time.
fn compare_times(runs: &mut [Run]) {
    let shipped = |run: &&Run| {
        let RunSettings { cutoff, lowpass, widen, epsilon, cull, alpha, .. } = RunSettings::defaults();
        let own = &run.settings;
        (own.cutoff, own.lowpass, own.epsilon) == (cutoff, lowpass, epsilon)
            && own.widen == widen
            && own.cull == cull
            && own.alpha == alpha
    };
    let baselines = runs.iter().filter(|run| run.implementation.method == SPLATS).filter(shipped);
    let baselines: Vec<Run> = baselines.filter(|run| run.ms().is_some()).cloned().collect();
    for run in runs {
        let alike = baselines.iter().filter(|other| {
            let what = |run: &Run| (run.points, run.size, run.overlap);
            run.scene == other.scene && what(run) == what(other)
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
