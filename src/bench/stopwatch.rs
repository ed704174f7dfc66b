//! How long frames take.

use super::engine::Ready;
use super::record::{Pass, Time};
use crate::error::Result;
use crate::frame::times::{Statistics, Times};
use crate::geometry::Camera;
use crate::settings::Settings;
use cpu_time::ProcessTime;
use std::time::{Duration, Instant};

/// How many frames are timed: at least so many, at most so many, and no more once the time is up.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Frames that do not count: the first makes pipelines and targets.
    pub warmup: usize,
    /// Fewest frames that count.
    pub least: usize,
    /// Most frames that count.
    pub most: usize,
    /// What the frames may take together.
    pub budget: Duration,
}

/// What a device that slows down when idle is given to speed up.
const WARM: Duration = Duration::from_millis(50);

impl Default for Effort {
    fn default() -> Self {
        Self { warmup: 1, least: 7, most: 1000, budget: Duration::from_secs(2) }
    }
}

/// Renders frames that do not count until there were enough and the device has had the time to speed up; how many.
fn warm_up(ready: &mut dyn Ready, camera: &Camera, settings: &Settings, effort: &Effort) -> Result<usize> {
    let (start, mut frames) = (Instant::now(), 0);
    while frames < effort.warmup || (frames < effort.most && start.elapsed() < WARM) {
        ready.frame(camera, settings, false)?;
        frames += 1;
    }
    Ok(frames)
}

/// Times frames. Whole frames are timed without timestamps, passes in other frames, which take turns: so neither disturbs the other, and
/// whatever else the machine does disturbs both alike.
pub fn time(ready: &mut dyn Ready, camera: &Camera, settings: &Settings, effort: &Effort) -> Result<Time> {
    let warmup = warm_up(ready, camera, settings, effort)?;
    let (mut whole, mut cpu, mut sums) = (Vec::new(), Vec::new(), Vec::new());
    let mut passes = Times::default();
    // Its first frame does not count.
    passes.add(Duration::ZERO, &ready.frame(camera, settings, true)?);
    let start = Instant::now();
    while whole.len() < effort.least || (whole.len() < effort.most && start.elapsed() < effort.budget) {
        let (begin, spent) = (Instant::now(), ProcessTime::now());
        ready.frame(camera, settings, false)?;
        whole.push(begin.elapsed().as_secs_f64() * 1e3);
        cpu.push(spent.elapsed().as_secs_f64() * 1e3);
        let times = ready.frame(camera, settings, true)?;
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
        multiple: None,
    })
}

/// Fewest pairs of frames that a ratio is made of.
const FEWEST_PAIRS: usize = 9;

/// Something that renders, what it sees, and how.
pub type Side<'a> = (&'a mut (dyn Ready + 'static), &'a Camera, &'a Settings);

/// How many times as long a frame of the second side takes as one of the first. Their frames take turns, so that whatever else the machine
/// does disturbs both alike; each quotient is of two frames one after the other.
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
