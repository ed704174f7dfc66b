//! Times of frames.

use super::engine::LoadedEngine;
use super::record::{Pass, Time};
use crate::error::Result;
use crate::frame::times::{Statistics, Times};
use crate::geometry::Camera;
use crate::settings::Settings;
use cpu_time::ProcessTime;
use std::time::{Duration, Instant};

/// How many frames are timed: between `least` and `most`, while the time lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Warm-up frames: the first one creates pipelines and targets.
    pub warmup: usize,
    /// Least number of timed frames.
    pub least: usize,
    /// Greatest number of timed frames.
    pub most: usize,
    /// Time for all frames together.
    pub budget: Duration,
}

/// Warm-up time for devices that reduce their clock when idle.
const WARM: Duration = Duration::from_millis(50);

impl Default for Effort {
    fn default() -> Self {
        Self { warmup: 1, least: 7, most: 1000, budget: Duration::from_secs(2) }
    }
}

/// Renders warm-up frames for at least [`WARM`]; returns their number.
fn warm_up(
    engine: &mut dyn LoadedEngine,
    camera: &Camera,
    settings: &Settings,
    effort: &Effort,
) -> Result<usize> {
    let (start, mut frames) = (Instant::now(), 0);
    while frames < effort.warmup || (frames < effort.most && start.elapsed() < WARM) {
        engine.frame(camera, settings, false)?;
        frames += 1;
    }
    Ok(frames)
}

/// Times frames. Whole frames and passes are timed in alternate frames: timestamps do not disturb the former, and other
/// load on the machine affects both alike.
pub fn time(
    engine: &mut dyn LoadedEngine,
    camera: &Camera,
    settings: &Settings,
    effort: &Effort,
) -> Result<Time> {
    let warmup = warm_up(engine, camera, settings, effort)?;
    let (mut whole, mut cpu, mut sums) = (Vec::new(), Vec::new(), Vec::new());
    let mut passes = Times::default();
    // The first frame with timestamps does not count.
    passes.add(Duration::ZERO, &engine.frame(camera, settings, true)?);
    let start = Instant::now();
    while whole.len() < effort.least || (whole.len() < effort.most && start.elapsed() < effort.budget) {
        let (begin, spent) = (Instant::now(), ProcessTime::now());
        engine.frame(camera, settings, false)?;
        whole.push(begin.elapsed().as_secs_f64() * 1e3);
        cpu.push(spent.elapsed().as_secs_f64() * 1e3);
        let times = engine.frame(camera, settings, true)?;
        if !times.is_empty() {
            sums.push(times.iter().map(|pass| pass.milliseconds).sum());
        }
        passes.add(Duration::ZERO, &times);
    }
    let pass = |(name, ms): (&'static str, Statistics)| Pass { name: name.into(), ms };
    Ok(Time {
        frames: whole.len(),
        warmup: warmup + 1,
        wall: Statistics::of(&whole).unwrap_or_default(),
        cpu: Statistics::of(&cpu).unwrap_or_default(),
        passes: passes.passes().map(pass).collect(),
        device: Statistics::of(&sums),
        baseline_ratio: None,
    })
}

/// Least number of pairs of frames for a ratio.
const FEWEST_PAIRS: usize = 9;

/// A loaded engine, its camera and its settings.
pub type Side<'a> = (&'a mut (dyn LoadedEngine + 'static), &'a Camera, &'a Settings);

/// Time of a frame of the second side relative to one of the first. Frames alternate, so other load on the machine
/// affects both alike; each quotient is of two consecutive frames.
pub fn ratio(
    (first, a, first_settings): Side<'_>,
    (second, b, second_settings): Side<'_>,
    effort: &Effort,
) -> Result<Option<Statistics>> {
    warm_up(first, a, first_settings, effort)?;
    warm_up(second, b, second_settings, effort)?;
    let (mut quotients, start) = (Vec::new(), Instant::now());
    while quotients.len() < effort.least.max(FEWEST_PAIRS)
        || (quotients.len() < effort.most && start.elapsed() < effort.budget)
    {
        let begin = Instant::now();
        first.frame(a, first_settings, false)?;
        let middle = Instant::now();
        second.frame(b, second_settings, false)?;
        quotients.push(middle.elapsed().as_secs_f64() / (middle - begin).as_secs_f64());
    }
    Ok(Statistics::of(&quotients))
}
