//! Times of frames of loaded engines.

use super::engine::LoadedEngine;
use super::record::{Clock, Pass, Time};
use super::stopwatch::{Effort, Sample, Samples, Work, take_turns, timed};
use crate::error::{Error, Result};
use crate::frame::times::Statistics;
use crate::geometry::Camera;
use crate::settings::Settings;

/// A loaded engine, its camera and its settings.
pub type Side<'a> = (&'a mut (dyn LoadedEngine + 'static), &'a Camera, &'a Settings);

/// A frame with timestamps, then a whole one without them, which they would disturb. The first frame also brings what other engines have
/// displaced from the caches back; a GPU, whose timestamps are the result, renders one more for that.
///
/// # Errors
/// Those of the frames.
pub fn turn((engine, camera, settings): &mut Side<'_>) -> Result<Sample> {
    if engine.clock() == Clock::Gpu {
        engine.frame(camera, settings, false)?;
    }
    let passes = engine.frame(camera, settings, true)?;
    let (_, sample) = timed(|| engine.frame(camera, settings, false))?;
    Ok(Sample { passes, ..sample })
}

/// Times frames of several engines that take turns.
///
/// # Errors
/// Those of its frames for each engine; the others go on.
pub fn time_frames(sides: &mut [Side<'_>], effort: &Effort) -> Vec<Result<Time>> {
    let all = take_turns(&mut sides.iter_mut().map(turns).collect::<Vec<_>>(), effort);
    let timed = all.into_iter().zip(sides);
    timed.map(|(samples, side)| samples.map(|samples| time(&samples, side.0.clock()))).collect()
}

fn turns<'a>(side: &'a mut Side<'_>) -> Work<'a, Error> {
    Box::new(|| turn(side))
}

fn time(samples: &Samples, clock: Clock) -> Time {
    let pass = |(name, ms): (&'static str, Statistics)| Pass { name: name.into(), ms };
    let frames_a_turn = if clock == Clock::Gpu { 3 } else { 2 };
    Time {
        clock,
        frames: samples.count(),
        warmup: frames_a_turn * samples.warmup,
        wall: samples.wall(),
        cpu: samples.cpu(),
        passes: samples.passes().map(pass).collect(),
        device: samples.device(),
        others: samples.others,
        baseline_ratio: None,
    }
}

/// Least number of pairs of frames for a ratio.
const FEWEST_PAIRS: usize = 9;

/// Time of a frame of the second side relative to one of the first, in pairs of consecutive frames: [`Samples::ratio`].
///
/// # Errors
/// Those of the frames.
pub fn ratio(first: Side<'_>, second: Side<'_>, effort: &Effort) -> Result<Option<Statistics>> {
    let by_wall = [&first, &second].iter().any(|side| side.0.clock() != Clock::Cpu);
    let least = effort.least.max(FEWEST_PAIRS);
    let effort = Effort { least, budget: effort.budget / 2, until: None, ..*effort };
    let both = take_turns(&mut [first, second].map(frames), &effort);
    let both = both.into_iter().collect::<Result<Vec<_>>>()?;
    Ok(both[1].ratio(&both[0], by_wall))
}

/// Frames without timestamps.
fn frames((engine, camera, settings): Side<'_>) -> Work<'_, Error> {
    Box::new(|| Ok(timed(|| engine.frame(camera, settings, false))?.1))
}
