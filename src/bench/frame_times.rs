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

/// Work of a frame of the second side relative to one of the first, in pairs of consecutive frames, by the clock of both, or wall time if their
/// clocks differ; and this clock. See [`Samples::ratio`].
///
/// # Errors
/// Those of the frames.
pub fn ratio(first: Side<'_>, second: Side<'_>, effort: &Effort) -> Result<(Option<Statistics>, Clock)> {
    let [clock, other] = [&first, &second].map(|side| side.0.clock());
    let clock = if clock == other { clock } else { Clock::Wall };
    let least = effort.least.max(FEWEST_PAIRS);
    let effort = Effort { least, budget: effort.budget / 2, until: None, ..*effort };
    let both = take_turns(&mut [first, second].map(|side| frames(side, clock)), &effort);
    let both = both.into_iter().collect::<Result<Vec<_>>>()?;
    Ok((both[1].ratio(&both[0], clock), clock))
}

/// Frames as [`turn`] renders them for timestamps, otherwise without these.
fn frames(mut side: Side<'_>, clock: Clock) -> Work<'_, Error> {
    Box::new(move || match clock {
        Clock::Gpu => turn(&mut side),
        _ => Ok(timed(|| side.0.frame(side.1, side.2, false))?.1),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::record::Memory;
    use crate::picture::Picture;
    use crate::vk::PassTime;
    use std::time::Duration;

    /// A GPU whose frames take these milliseconds by its timestamps, whatever their wall time.
    struct Gpu(f64);

    impl LoadedEngine for Gpu {
        fn frame(&mut self, _: &Camera, _: &Settings, timed: bool) -> Result<Vec<PassTime>> {
            let pass = PassTime { label: "surface", milliseconds: self.0 };
            Ok(timed.then_some(pass).into_iter().collect())
        }

        fn picture(&mut self, _: &Camera, _: &Settings) -> Result<Picture> {
            Ok(Picture::default())
        }

        fn clock(&self) -> Clock {
            Clock::Gpu
        }

        fn memory(&self) -> Memory {
            Memory::default()
        }
    }

    #[test]
    fn ratios_on_a_gpu_are_of_its_timestamps() {
        let identity = glam::DMat4::IDENTITY;
        let camera = Camera { view: identity, projection: identity, reversed: false };
        let settings = Settings::default();
        let effort = Effort { warmup: 1, least: 1, most: 9, budget: Duration::ZERO, until: None };
        let [mut base, mut own] = [Gpu(2.0), Gpu(3.0)];
        let ratio = ratio((&mut base, &camera, &settings), (&mut own, &camera, &settings), &effort);
        let (ratio, clock) = ratio.unwrap();
        let ratio = ratio.unwrap();
        assert_eq!((ratio.min, ratio.median, ratio.max, clock), (1.5, 1.5, 1.5, Clock::Gpu));
    }
}
