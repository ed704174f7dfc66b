//! Times of frames.

use super::engine::LoadedEngine;
use super::load::Load;
use super::record::{Clock, Pass, Time};
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
    /// Time after which one frame suffices.
    pub until: Option<Instant>,
}

/// Warm-up time for devices that reduce their clock when idle.
const WARM: Duration = Duration::from_millis(50);

impl Default for Effort {
    fn default() -> Self {
        Self { warmup: 1, least: 7, most: 1000, budget: Duration::from_secs(2), until: None }
    }
}

/// A loaded engine, its camera and its settings.
pub type Side<'a> = (&'a mut (dyn LoadedEngine + 'static), &'a Camera, &'a Settings);

/// Renders warm-up frames for at least [`WARM`]; returns their number.
fn warm_up((engine, camera, settings): &mut Side<'_>, effort: &Effort) -> Result<usize> {
    let (start, mut frames) = (Instant::now(), 0);
    while frames < effort.warmup || (frames < effort.most && start.elapsed() < WARM) {
        engine.frame(camera, settings, false)?;
        frames += 1;
    }
    Ok(frames)
}

/// Times of one of several engines so far.
#[derive(Default)]
struct Turns {
    warmup: usize,
    /// Wall and processor time of whole frames, and sums of the passes, ms.
    whole: Vec<f64>,
    cpu: Vec<f64>,
    sums: Vec<f64>,
    passes: Times,
    spent: Duration,
}

impl Turns {
    fn wants_more(&self, effort: &Effort) -> bool {
        let count = self.whole.len();
        if effort.until.is_some_and(|until| Instant::now() >= until) {
            return count == 0;
        }
        count < effort.least || (count < effort.most && self.spent < effort.budget)
    }

    /// A frame with timestamps, then a whole one without them, which they would disturb. The first frame also brings what other engines have
    /// displaced from the caches back; a GPU, whose timestamps are the result, renders one more for that.
    fn take(&mut self, (engine, camera, settings): &mut Side<'_>) -> Result<()> {
        let start = Instant::now();
        if engine.clock() == Clock::Gpu {
            engine.frame(camera, settings, false)?;
        }
        let times = engine.frame(camera, settings, true)?;
        let (begin, spent) = (Instant::now(), ProcessTime::now());
        engine.frame(camera, settings, false)?;
        self.whole.push(begin.elapsed().as_secs_f64() * 1e3);
        self.cpu.push(spent.elapsed().as_secs_f64() * 1e3);
        if !times.is_empty() {
            self.sums.push(times.iter().map(|pass| pass.milliseconds).sum());
        }
        self.passes.add(Duration::ZERO, &times);
        self.spent += start.elapsed();
        Ok(())
    }

    fn time(&self, clock: Clock, others: Option<f64>) -> Time {
        let pass = |(name, ms): (&'static str, Statistics)| Pass { name: name.into(), ms };
        Time {
            clock,
            frames: self.whole.len(),
            warmup: self.warmup,
            wall: Statistics::of(&self.whole).unwrap_or_default(),
            cpu: Statistics::of(&self.cpu).unwrap_or_default(),
            passes: self.passes.passes().map(pass).collect(),
            device: Statistics::of(&self.sums),
            others,
            baseline_ratio: None,
        }
    }
}

/// Times frames of several engines that take turns, so that other load on the machine affects all alike.
///
/// # Errors
/// Those of its frames for each engine; the others go on.
pub fn take_turns(sides: &mut [Side<'_>], effort: &Effort) -> Vec<Result<Time>> {
    let start = |side: &mut Side<'_>| {
        let warmup = warm_up(side, effort)?;
        let mut turns = Turns { warmup: warmup + 1, ..Turns::default() };
        // The first frame with timestamps does not count.
        turns.passes.add(Duration::ZERO, &side.0.frame(side.1, side.2, true)?);
        Ok(turns)
    };
    let mut all: Vec<Result<Turns>> = sides.iter_mut().map(start).collect();
    let load = Load::start();
    loop {
        let mut any = false;
        for (side, turns) in sides.iter_mut().zip(&mut all) {
            let Ok(own) = turns else { continue };
            if own.wants_more(effort) {
                any = true;
                if let Err(error) = own.take(side) {
                    *turns = Err(error);
                }
            }
        }
        if !any {
            break;
        }
    }
    let others = load.others();
    let times = all.into_iter().zip(sides);
    times.map(|(turns, side)| turns.map(|turns| turns.time(side.0.clock(), others))).collect()
}

/// Least number of pairs of frames for a ratio.
const FEWEST_PAIRS: usize = 9;

/// Time of a frame of the second side relative to one of the first: of processor time, or of wall time where a GPU does the work. Frames
/// alternate, so other load on the machine affects both alike; each quotient is of two consecutive frames.
///
/// # Errors
/// Those of the frames.
pub fn ratio(mut first: Side<'_>, mut second: Side<'_>, effort: &Effort) -> Result<Option<Statistics>> {
    warm_up(&mut first, effort)?;
    warm_up(&mut second, effort)?;
    let (mut quotients, start) = (Vec::new(), Instant::now());
    while quotients.len() < effort.least.max(FEWEST_PAIRS)
        || (quotients.len() < effort.most && start.elapsed() < effort.budget)
    {
        let by_wall = [&first, &second].iter().any(|side| side.0.clock() != Clock::Cpu);
        let before = one(&mut first, by_wall)?;
        quotients.push(one(&mut second, by_wall)? / before);
    }
    Ok(Statistics::of(&quotients))
}

/// Wall or processor time of a frame, s.
fn one((engine, camera, settings): &mut Side<'_>, by_wall: bool) -> Result<f64> {
    let (begin, spent) = (Instant::now(), ProcessTime::now());
    engine.frame(camera, settings, false)?;
    Ok(if by_wall { begin.elapsed() } else { spent.elapsed() }.as_secs_f64())
}
