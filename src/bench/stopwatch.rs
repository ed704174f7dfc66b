//! How long frames take.

use super::engine::Ready;
use super::record::{Pass, Time};
use super::times::{Statistics, Times};
use crate::error::Result;
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

impl Default for Effort {
    fn default() -> Self {
        Self { warmup: 2, least: 7, most: 50, budget: Duration::from_secs(2) }
    }
}

/// Times frames. Whole frames are timed without timestamps, passes in other frames, which take turns: so neither disturbs the other, and
/// whatever else the machine does disturbs both alike.
pub fn time(ready: &mut dyn Ready, camera: &Camera, settings: &Settings, effort: &Effort) -> Result<Time> {
    for _ in 0..effort.warmup {
        ready.frame(camera, settings, false)?;
    }
    let (mut whole, mut cpu, mut sums) = (Vec::new(), Vec::new(), Vec::new());
    let mut passes = Times::default();
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
        warmup: effort.warmup,
        wall: Statistics::of(&whole).unwrap_or_default(),
        cpu: Statistics::of(&cpu).unwrap_or_default(),
        passes: passes.passes().map(pass).collect(),
        device: Statistics::of(&sums),
        multiple: None,
    })
}
