//! One call of the bench: all runs of some suites on one machine.

use super::record::{Agreement, Gpu, Host, Made, Run, SPLATS, Session};
use super::runner::{Options, Runner};
use super::suites::{Own, Suite};
use super::{code, hard};
use crate::error::Result;
use crate::progress::Progress;
use crate::reference::Comparison;
use crate::vk::Device;
use jiff::Timestamp;
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;
use sysinfo::System;

/// Stage of the progress; its unit is the run.
const STAGE: &str = "measuring";

/// What is wanted of a session.
pub struct Wanted {
    /// The suites, in this order.
    pub suites: Vec<Suite>,
    /// What the user brings, for [`Suite::Own`].
    pub own: Own,
    /// The device; without one, what needs it is refused.
    pub device: Option<Arc<Device>>,
    /// Whether the device runs under the validation layers.
    pub validated: bool,
    /// Where exact pictures are kept between calls.
    pub cache: Option<PathBuf>,
    /// The command that repeats it.
    pub command: String,
}

/// Measures.
///
/// # Errors
/// If the device is lost; what else cannot be rendered is refused in its run.
pub fn measure(wanted: &Wanted, progress: &dyn Progress) -> Result<Session> {
    let (date, start) = (Timestamp::now(), Instant::now());
    let plans = |suite: &Suite| suite.plans(&wanted.own);
    let total = wanted.suites.iter().map(|suite| plans(suite).len() as u64).sum();
    let (mut runs, mut exhibits) = (Vec::new(), Vec::new());
    progress.at(STAGE, 0, total);
    for suite in &wanted.suites {
        let options = Options {
            device: wanted.device.clone(),
            cache: wanted.cache.clone(),
            truth: suite.truth(),
            effort: suite.effort(),
        };
        let mut runner = Runner::new(options, wanted.own.subjects.clone());
        for plan in plans(suite) {
            let begin = Instant::now();
            let mut run = runner.run(&plan)?;
            log::info!("{} {} {:?}: {:.2?}", plan.scene, plan.points, plan.figure, begin.elapsed());
            run.exhibit.iter_mut().for_each(|index| *index += exhibits.len());
            runs.push(run);
            progress.at(STAGE, runs.len() as u64, total);
        }
        exhibits.extend(runner.exhibits());
    }
    compare_times(&mut runs);
    let sweeps = match &wanted.device {
        Some(device) if wanted.suites.contains(&Suite::Hard) => {
            hard::run(device, &hard::Options::default(), progress)?
        }
        _ => Vec::new(),
    };
    let made = Made {
        version: env!("CARGO_PKG_VERSION").into(),
        commit: code::COMMIT.into(),
        code: code::DIGEST.into(),
        date,
        seconds: start.elapsed().as_secs_f64(),
        command: wanted.command.clone(),
        suites: wanted.suites.iter().map(|suite| suite.name().into()).collect(),
        host: host(),
        device: wanted.device.as_deref().map(|device| gpu(device, wanted.validated)),
    };
    Ok(Session { made, runs, sweeps, exhibits })
}

/// Tells times as multiples of what the yardstick's splats take for the same points, pixels and settings.
fn compare_times(runs: &mut [Run]) {
    let yardsticks: Vec<(Run, f64)> = runs
        .iter()
        .filter(|run| run.contender.method == SPLATS)
        .filter_map(|run| Some((run.clone(), run.ms()?)))
        .collect();
    let alike = |a: &Run, b: &Run| {
        let what = |run: &Run| (run.points, run.size, run.overlap);
        a.scene == b.scene && what(a) == what(b) && a.setting == b.setting
    };
    for run in runs {
        let unit = yardsticks.iter().find(|(other, _)| alike(run, other)).map(|(_, ms)| *ms);
        if let (Some(time), Some(unit)) = (&mut run.time, unit) {
            time.multiple = Some(time.wall.median / unit);
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
    Gpu { name: description.name.clone(), driver: description.driver.clone(), validated }
}

impl Agreement {
    /// What a comparison with the reference found.
    pub fn of(found: &Comparison) -> Self {
        Self {
            object: found.object_pixels as u64,
            doubtful: found.doubtful as u64,
            failed: found.failed as u64,
            colour: found.worst.colour,
            normal: found.worst.normal,
            depth: found.worst.depth,
        }
    }
}
