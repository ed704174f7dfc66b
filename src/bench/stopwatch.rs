//! Times of repeated work: whatever takes turns is warmed up, sampled and summed up here.

use super::load::Load;
use super::record::Clock;
use crate::frame::times::{Statistics, Times};
use crate::vk::PassTime;
use cpu_time::{ProcessTime, ThreadTime};
use std::time::{Duration, Instant};

/// How many turns of each piece of work are timed: between `least` and `most`, while the time lasts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Warm-up turns: the first one creates pipelines and targets.
    pub warmup: usize,
    /// Least number of timed turns.
    pub least: usize,
    /// Greatest number of timed turns.
    pub most: usize,
    /// Time for all turns of a piece of work; of several that take turns, on average.
    pub budget: Duration,
    /// Time after which one turn suffices.
    pub until: Option<Instant>,
}

/// Warm-up time for devices that reduce their clock when idle.
const WARM: Duration = Duration::from_millis(50);

impl Default for Effort {
    fn default() -> Self {
        Self { warmup: 1, least: 7, most: 1000, budget: Duration::from_secs(2), until: None }
    }
}

/// Times of one turn, ms.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    /// Wall time.
    pub wall: f64,
    /// Processor time; NaN if it is unknown.
    pub cpu: f64,
    /// Passes by the device's timestamps; empty without.
    pub passes: Vec<PassTime>,
}

/// Work that takes turns: does it once and returns the times, of which it may leave out what comes before and after.
pub type Work<'a, E> = Box<dyn FnMut() -> Result<Sample, E> + 'a>;

/// Does work, and times it with the processor time of all threads.
///
/// # Errors
/// Those of the work.
pub fn timed<T, E>(work: impl FnOnce() -> Result<T, E>) -> Result<(T, Sample), E> {
    timed_by(|| ProcessTime::now().as_duration(), work)
}

/// The same with the processor time of this thread alone.
///
/// # Errors
/// Those of the work.
pub fn timed_on_thread<T, E>(work: impl FnOnce() -> Result<T, E>) -> Result<(T, Sample), E> {
    timed_by(|| ThreadTime::now().as_duration(), work)
}

fn timed_by<T, E>(
    processor: impl Fn() -> Duration,
    work: impl FnOnce() -> Result<T, E>,
) -> Result<(T, Sample), E> {
    let (begin, spent) = (Instant::now(), processor());
    let made = work()?;
    let [wall, cpu] = [begin.elapsed(), processor() - spent].map(|time| time.as_secs_f64() * 1e3);
    Ok((made, Sample { wall, cpu, passes: Vec::new() }))
}

/// Samples of all turns of some work.
#[derive(Default)]
pub struct Samples {
    /// Warm-up turns, of which there are no samples.
    pub warmup: usize,
    /// Logical processors that other programs kept busy meanwhile, on average; none if it is unknown.
    pub others: Option<f64>,
    wall: Vec<f64>,
    cpu: Vec<f64>,
    device: Vec<f64>,
    passes: Times,
    spent: Duration,
}

impl Samples {
    /// Takes warm-up turns for at least [`WARM`].
    fn warm_up<E>(work: &mut Work<'_, E>, effort: &Effort) -> Result<Self, E> {
        let (start, mut samples, mut last) = (Instant::now(), Self::default(), Sample::default());
        while samples.warmup < effort.warmup || (samples.warmup < effort.most && start.elapsed() < WARM) {
            last = work()?;
            samples.warmup += 1;
        }
        // It is the frame that `Times` discards.
        samples.passes.add(Duration::ZERO, &last.passes);
        Ok(samples)
    }

    fn take<E>(&mut self, work: &mut Work<'_, E>) -> Result<(), E> {
        let start = Instant::now();
        let Sample { wall, cpu, passes } = work()?;
        self.wall.push(wall);
        self.cpu.push(cpu);
        if !passes.is_empty() {
            self.device.push(passes.iter().map(|pass| pass.milliseconds).sum());
        }
        self.passes.add(Duration::ZERO, &passes);
        self.spent += start.elapsed();
        Ok(())
    }

    /// Number of samples.
    pub fn count(&self) -> usize {
        self.wall.len()
    }

    /// Wall time.
    pub fn wall(&self) -> Statistics {
        Statistics::of(&self.wall).unwrap_or_default()
    }

    /// Processor time.
    pub fn cpu(&self) -> Statistics {
        Statistics::of(&self.cpu).unwrap_or_default()
    }

    /// Sum of the passes of a turn; none without timestamps.
    pub fn device(&self) -> Option<Statistics> {
        Statistics::of(&self.device)
    }

    /// Passes, in their order; empty without timestamps.
    pub fn passes(&self) -> impl Iterator<Item = (&'static str, Statistics)> {
        self.passes.passes()
    }

    /// Time by this clock relative to that of `base`, which took turns with this work: each quotient is of the same turn. None without times by
    /// this clock.
    pub fn ratio(&self, base: &Self, clock: Clock) -> Option<Statistics> {
        let of = |samples: &Self| match clock {
            Clock::Gpu => samples.device.clone(),
            Clock::Cpu => samples.cpu.clone(),
            Clock::Wall => samples.wall.clone(),
        };
        let quotients: Vec<f64> = of(self).iter().zip(of(base)).map(|(own, base)| own / base).collect();
        Statistics::of(&quotients)
    }
}

/// Times several pieces of work that take turns, equally often from the first turn to the last, so that other load on the machine affects all alike.
///
/// # Errors
/// Those of its turns for each of them; the others go on.
pub fn take_turns<E>(all: &mut [Work<'_, E>], effort: &Effort) -> Vec<Result<Samples, E>> {
    let mut found: Vec<_> = all.iter_mut().map(|work| Samples::warm_up(work, effort)).collect();
    let load = Load::start();
    while want_more(&found, effort) {
        for (work, samples) in all.iter_mut().zip(&mut found) {
            let Ok(own) = samples else { continue };
            if let Err(error) = own.take(work) {
                *samples = Err(error);
            }
        }
    }
    let others = load.others();
    found.iter_mut().flatten().for_each(|samples| samples.others = others);
    found
}

/// Whether works that have all had as many turns take another.
fn want_more<E>(found: &[Result<Samples, E>], effort: &Effort) -> bool {
    let working = || found.iter().flatten();
    let Some(turns) = working().map(Samples::count).next() else { return false };
    if effort.until.is_some_and(|until| Instant::now() >= until) {
        return turns == 0;
    }
    let spent: Duration = working().map(|samples| samples.spent).sum();
    let budget = effort.budget * working().count() as u32;
    turns < effort.least || (turns < effort.most && spent < budget)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One turn for warm-up, however fast it is, and three that count.
    const THREE: Effort = Effort { warmup: 1, least: 3, most: 1, budget: Duration::ZERO, until: None };

    /// Work whose turns take `scale` · 1, 2, 3 … ms.
    fn rising(scale: f64) -> Work<'static, ()> {
        let mut turn = 0.0;
        Box::new(move || {
            turn += 1.0;
            let passes = vec![PassTime { label: "surface", milliseconds: turn }];
            Ok(Sample { wall: scale * turn, cpu: turn * turn, passes })
        })
    }

    #[test]
    fn warm_up_turns_have_no_samples_and_quotients_are_of_the_same_turn() {
        let found = take_turns(&mut [rising(1.0), rising(4.0)], &THREE);
        let [base, own] = [0, 1].map(|i| found[i].as_ref().unwrap());
        assert_eq!((own.warmup, own.count(), own.wall().min, own.wall().max), (1, 3, 8.0, 16.0));
        assert_eq!(own.ratio(base, Clock::Wall).map(|ratio| (ratio.min, ratio.max)), Some((4.0, 4.0)));
        assert_eq!(own.ratio(base, Clock::Cpu).map(|ratio| ratio.median), Some(1.0));
        assert_eq!(own.passes().map(|(name, ms)| (name, ms.min)).collect::<Vec<_>>(), [("surface", 2.0)]);
        assert_eq!(own.device().map(|sum| sum.median), Some(3.0));
    }

    #[test]
    fn fast_work_takes_as_many_turns_as_slow_work() {
        let order = std::cell::RefCell::new(Vec::new());
        let work = |name, ms| -> Work<'_, ()> {
            let order = &order;
            Box::new(move || {
                std::thread::sleep(Duration::from_millis(ms));
                order.borrow_mut().push(name);
                Ok(Sample::default())
            })
        };
        let effort = Effort { most: 20, budget: Duration::from_millis(6), ..THREE };
        let found = take_turns(&mut [work("slow", 2), work("fast", 0)], &effort);
        let [slow, fast] = [0, 1].map(|i| found[i].as_ref().unwrap().count());
        assert!(slow == fast && slow < 20, "{slow} {fast}");
        // To the end, after their warm-up.
        let order = order.into_inner();
        let turns = &order[order.len() - 2 * slow..];
        assert!(turns.chunks(2).all(|turn| turn == ["slow", "fast"]), "{turns:?}");
    }

    #[test]
    fn work_that_fails_does_not_end_the_others() {
        let mut left = 4;
        let failing: Work<'_, &str> = Box::new(|| {
            left -= 1;
            if left > 0 { Ok(Sample::default()) } else { Err("lost") }
        });
        let found = take_turns(&mut [failing, Box::new(|| Ok(Sample::default()))], &THREE);
        assert_eq!(found[0].as_ref().err(), Some(&"lost"));
        assert_eq!(found[1].as_ref().map(Samples::count), Ok(3));
    }

    #[test]
    fn work_has_the_time_of_its_threads() {
        let work = || {
            let sum: f64 = (0..200_000).map(|i| std::hint::black_box(f64::from(i)).sqrt()).sum();
            Ok::<_, ()>(sum)
        };
        let beside = || std::thread::scope(|scope| scope.spawn(work).join().expect("it does not panic"));
        let [all, own] = [timed(beside), timed_on_thread(beside)].map(|timed| timed.unwrap().1.cpu);
        assert!(all > own, "{all} ms of all threads, {own} ms of this one");
    }
}
