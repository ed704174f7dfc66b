//! Adaptive resolution: while the camera moves, frames are as fine as the time budget allows; at rest they have full quality.

use super::cost::{Cost, Work};
use super::quality::{Quality, Workload};
use std::time::{Duration, Instant};

/// How long the camera rests, at least, before a frame of full quality is rendered.
const REST: Duration = Duration::from_millis(180);
/// Part of the budget that a newly chosen quality may be expected to take; the rest absorbs errors of the estimate.
const TARGET: f64 = 0.8;
/// Expected part of the budget above which a coarser quality is chosen.
const LIMIT: f64 = 1.0;
/// Part of the budget that the last frame may have taken for a finer quality to be considered; that takes at most 1.6 times as long.
const HEADROOM: f64 = 0.9;
/// How many frames in a row must leave time before the quality becomes finer: a single fast frame may be chance.
const PATIENCE: u32 = 4;
/// The greatest number of such frames, after finer qualities were too slow again and again.
const MAX_PATIENCE: u32 = 64;
/// Number of frames after which a finer quality counts as stable.
const STABLE_FRAMES: u32 = 40;
/// The greatest ratio of a finer quality's blur to the present one's for which a change is worth it.
const MAX_BLUR_RATIO: f64 = 0.97;

/// Duration of a frame, and what it depended on.
#[derive(Clone, Copy, Debug)]
pub struct FrameTime {
    /// Duration, ms.
    pub ms: f64,
    /// Whether the camera moved.
    pub moving: bool,
    /// Whether render targets or buffers were created for it.
    pub created: bool,
}

/// Chooses the quality of each frame from the times of earlier ones.
#[derive(Clone, Debug)]
pub struct AdaptiveResolution {
    /// Time budget of a frame while the camera moves, ms.
    budget: f64,
    cost: Cost,
    /// Whether a frame was measured while the camera moved: from then on, frames at rest are not learnt from.
    moving_measured: bool,
    /// Work and time, ms, of the last frame of full quality.
    full_frame: Option<(Work, f64)>,
    chosen: Quality,
    last_move: Option<Instant>,
    /// Duration of the last frame, ms.
    last_ms: f64,
    /// The quality before frames became too slow, perhaps because of other programs.
    last_good: Option<Quality>,
    /// Frames in a row that left time for a finer quality.
    fast_frames: u32,
    patience: u32,
    /// Frames since a finer quality was chosen.
    frames_since_finer: u32,
}

impl AdaptiveResolution {
    /// Starts without measurements; `budget` is in ms.
    pub fn new(budget: f64) -> Self {
        Self {
            budget,
            cost: Cost::default(),
            moving_measured: false,
            full_frame: None,
            chosen: Quality::FULL,
            last_move: None,
            last_ms: 0.0,
            last_good: None,
            fast_frames: 0,
            patience: PATIENCE,
            frames_since_finer: STABLE_FRAMES,
        }
    }

    /// Forgets all measurements: another scene is shown, or with other settings.
    pub fn reset(&mut self) {
        *self = Self { last_move: self.last_move, ..Self::new(self.budget) };
    }

    /// Whether a frame was measured.
    pub fn has_measured(&self) -> bool {
        self.full_frame.is_some() || self.moving_measured
    }

    /// Notes that the camera moves.
    pub fn moved(&mut self, now: Instant) {
        self.last_move = Some(now);
    }

    /// Chooses the quality of a frame that begins now.
    pub fn quality(&mut self, now: Instant, workload: &Workload) -> Quality {
        if !self.is_moving(now) {
            return Quality::FULL;
        }
        self.choose(workload);
        self.chosen
    }

    /// Whether the camera moves.
    pub fn is_moving(&self, now: Instant) -> bool {
        self.last_move.is_some_and(|moved| now < moved + self.rest())
    }

    /// How long the camera has to rest. Where frames of full quality are slow, it is longer: a short pause should not cost one.
    fn rest(&self) -> Duration {
        REST.max(Duration::from_secs_f64(1e-3 * self.full_frame.map_or(0.0, |(_, ms)| ms)).min(4 * REST))
    }

    /// When a frame of full quality is due, if the last one was coarser.
    pub fn refine_at(&self, now: Instant) -> Option<Instant> {
        let rests = self.last_move? + self.rest();
        (self.chosen != Quality::FULL && now < rests).then_some(rests)
    }

    /// Learns from the duration of a frame.
    pub fn record(
        &mut self,
        quality: Quality,
        workload: &Workload,
        FrameTime { ms, moving, created }: FrameTime,
    ) {
        let known = self.has_measured();
        let work = workload.work(quality);
        if !moving && quality == Quality::FULL {
            // A frame that created resources took longer for that: the earlier time of the same work holds, if there is one.
            let same = self.full_frame.filter(|(known, _)| created && *known == work);
            let ms = ms.clamp(0.0, 1e6).min(same.map_or(f64::INFINITY, |(_, ms)| ms));
            self.full_frame = Some((work, ms));
        }
        if created && known {
            return;
        }
        if let Some((full_work, full_ms)) = self.full_frame.filter(|_| moving) {
            // Two frames of different work separate the cost of pixels from that of surfels. If the device is busier now, it would be for
            // the full frame, too.
            let slowdown = (ms / self.cost.of(work)).max(1.0);
            self.cost.learn(full_work, slowdown * full_ms);
        }
        if moving || !self.moving_measured {
            self.cost.learn(work, ms);
        }
        (self.moving_measured, self.last_ms) = (self.moving_measured || moving, ms);
    }

    /// Expected time of a frame, as part of the budget.
    fn expected(&self, workload: &Workload, quality: Quality) -> f64 {
        let (work, full) = (workload.work(quality), workload.work(Quality::FULL));
        let part = (work.pixels / full.pixels).max(work.surfels / full.surfels.max(1.0));
        let bound = self.full_frame.filter(|_| !self.moving_measured).map_or(0.0, |(_, ms)| part * ms);
        self.cost.of(work).max(bound) / self.budget
    }

    /// Keeps the present quality unless it is too slow, or enough frames in a row have left time for a finer one.
    fn choose(&mut self, workload: &Workload) {
        self.frames_since_finer = self.frames_since_finer.saturating_add(1);
        if self.frames_since_finer == STABLE_FRAMES {
            self.patience = (self.patience / 2).max(PATIENCE);
        }
        if self.expected(workload, self.chosen) > LIMIT {
            if self.frames_since_finer < STABLE_FRAMES {
                // The finer quality did not last: the next one waits longer.
                self.patience = (2 * self.patience).min(MAX_PATIENCE);
                self.frames_since_finer = STABLE_FRAMES;
                self.last_good = None;
            } else {
                self.last_good.get_or_insert(self.chosen);
            }
            (self.chosen, self.fast_frames) = (self.coarser(workload), 0);
            return;
        }
        let back = self.last_good.filter(|good| self.expected(workload, *good) <= TARGET);
        let next = back.or_else(|| {
            self.finest(workload, |quality| workload.is_one_step_finer_at_most(*quality, self.chosen))
        });
        let finer = next.filter(|next| workload.blur(*next) < MAX_BLUR_RATIO * workload.blur(self.chosen));
        let finer = finer.filter(|_| self.last_ms <= HEADROOM * self.budget);
        self.fast_frames = if finer.is_some() { self.fast_frames + 1 } else { 0 };
        if let Some(finer) = finer.filter(|_| self.fast_frames >= self.patience) {
            (self.chosen, self.fast_frames, self.frames_since_finer, self.last_good) = (finer, 0, 0, None);
        }
    }

    /// The finest quality within the budget that has neither more pixels nor more surfels; the fastest of all if there is none.
    fn coarser(&self, workload: &Workload) -> Quality {
        let no_more =
            |quality: &Quality| quality.scale <= self.chosen.scale && quality.lod >= self.chosen.lod;
        let fastest = || least(workload.choices(), |quality| self.cost.of(workload.work(quality)));
        self.finest(workload, no_more).or_else(fastest).unwrap_or(Quality::FULL)
    }

    /// The quality with the least blur within the budget, of those that `among` accepts.
    fn finest(&self, workload: &Workload, among: impl Fn(&Quality) -> bool) -> Option<Quality> {
        let fits = |quality: &Quality| self.expected(workload, *quality) <= TARGET;
        least(workload.choices().filter(among).filter(fits), |quality| workload.blur(quality))
    }
}

/// The choice with the least value.
fn least(choices: impl Iterator<Item = Quality>, value: impl Fn(Quality) -> f64) -> Option<Quality> {
    choices.min_by(|a, b| value(*a).total_cmp(&value(*b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn workload() -> Workload {
        of_lods(2.0)
    }

    /// Eleven levels of detail of ever fewer surfels, of which the first has this level of detail, px.
    fn of_lods(first: f64) -> Workload {
        let level = |step: i32| if step == 0 { 0.0 } else { first * 1.26f64.powi(step - 1) };
        Workload::new(8e5, (0..11).map(|step| (level(step), 4e5 / 1.6f64.powi(step))))
    }

    /// Frame times of a device, ms: a fixed part, that of all pixels, that of all surfels. Each coarser level of detail costs 5 % more a pixel.
    #[derive(Clone, Copy)]
    struct Load {
        fixed: f64,
        pixels: f64,
        surfels: f64,
    }

    impl Load {
        fn time(&self, quality: Quality) -> f64 {
            self.time_of(workload().work(quality))
        }

        fn time_of(&self, work: Work) -> f64 {
            let fewer = 1.0 + 0.05 * (4e5 / work.surfels).ln() / 1.6f64.ln();
            self.fixed + self.pixels * fewer * work.pixels / 8e5 + self.surfels * work.surfels / 4e5
        }
    }

    const LOADS: [Load; 6] = [
        Load { fixed: 5.0, pixels: 10.0, surfels: 20.0 },
        Load { fixed: 5.0, pixels: 40.0, surfels: 200.0 },
        Load { fixed: 2.0, pixels: 300.0, surfels: 10.0 },
        Load { fixed: 20.0, pixels: 5.0, surfels: 900.0 },
        Load { fixed: 10.0, pixels: 200.0, surfels: 3000.0 },
        Load { fixed: 0.1, pixels: 0.5, surfels: 1.0 },
    ];

    /// A frame while the camera moves.
    fn moving(ms: f64) -> FrameTime {
        FrameTime { ms, moving: true, created: false }
    }

    /// The qualities and times of `count` frames while the camera moves.
    fn frames(
        adaptive: &mut AdaptiveResolution,
        load: impl Fn(usize) -> Load,
        count: usize,
    ) -> Vec<(Quality, f64)> {
        let now = Instant::now();
        adaptive.moved(now);
        let mut frame = |i: usize| {
            let quality = adaptive.quality(now, &workload());
            let time = load(i).time(quality);
            adaptive.record(quality, &workload(), moving(time));
            (quality, time)
        };
        (0..count).map(&mut frame).collect()
    }

    /// Adaptive resolution after a first frame of full quality.
    fn started(load: Load) -> AdaptiveResolution {
        let mut adaptive = AdaptiveResolution::new(60.0);
        adaptive.record(
            Quality::FULL,
            &workload(),
            FrameTime { moving: false, ..moving(load.time(Quality::FULL)) },
        );
        adaptive
    }

    #[test]
    fn moving_frames_keep_to_the_budget_from_the_first_and_the_quality_settles() {
        for load in LOADS {
            let frames = frames(&mut started(load), |_| load, 400);
            for (i, (_, time)) in frames.iter().enumerate() {
                assert!(*time <= 90.0, "{:?}", &frames[..=i]);
            }
            let changes = frames[200..].windows(2).filter(|pair| pair[0].0 != pair[1].0).count();
            assert!(changes <= 2, "{changes} changes: {:?}", &frames[200..]);
            let (last, time) = frames[399];
            let work = workload();
            let finer = work.choices().filter(|q| work.blur(*q) < 0.7 * work.blur(last));
            let best = finer.map(|quality| load.time(quality)).fold(f64::INFINITY, f64::min);
            assert!(best > 0.8 * 60.0, "{last:?} of {time} ms, a finer one takes {best}");
        }
    }

    #[test]
    fn fast_frames_have_full_quality() {
        let load = LOADS[0];
        assert!(
            frames(&mut started(load), |_| load, 50).iter().all(|(quality, _)| *quality == Quality::FULL)
        );
        assert_eq!(started(load).refine_at(Instant::now()), None);
    }

    #[test]
    fn the_next_frame_adapts_to_a_heavier_load_and_full_quality_returns_after_it() {
        let (light, heavy) = (LOADS[0], LOADS[1]);
        let load = |i| if (50..100).contains(&i) { heavy } else { light };
        let frames = frames(&mut started(light), load, 300);
        assert!(frames[50].1 > 90.0, "the change of load is not predictable");
        let slow = frames[51..].iter().position(|(_, time)| *time > 90.0);
        assert_eq!(slow.map(|slow| &frames[48 + slow..52 + slow]), None);
        assert_eq!(frames[160].0, Quality::FULL);
    }

    #[test]
    fn under_a_varying_load_finer_frames_become_rarer() {
        let load = |i: usize| if i % 8 < 4 { LOADS[0] } else { LOADS[1] };
        let frames = frames(&mut started(LOADS[1]), load, 800);
        let slow = |part: &[(Quality, f64)]| part.iter().filter(|(_, time)| *time > 90.0).count();
        assert!(slow(&frames[400..]) <= 8, "{}", slow(&frames[400..]));
    }

    #[test]
    fn the_time_of_creating_resources_does_not_count() {
        for load in LOADS {
            let choices = |making: f64| {
                let mut adaptive = AdaptiveResolution::new(60.0);
                let whole = load.time(Quality::FULL);
                for (ms, created) in [(whole, false), (whole + making, true)] {
                    adaptive.record(Quality::FULL, &workload(), FrameTime { ms, moving: false, created });
                }
                let (now, mut before) = (Instant::now(), Quality::FULL);
                adaptive.moved(now);
                let mut frame = |_| {
                    let quality = adaptive.quality(now, &workload());
                    let created = std::mem::replace(&mut before, quality) != quality;
                    let ms = load.time(quality) + if created { making } else { 0.0 };
                    adaptive.record(quality, &workload(), FrameTime { created, ..moving(ms) });
                    quality
                };
                (0..200).map(&mut frame).collect::<Vec<_>>()
            };
            let other = choices(0.0).into_iter().zip(choices(200.0)).position(|(one, other)| one != other);
            assert_eq!(other, None);
        }
        let mut adaptive = AdaptiveResolution::new(60.0);
        adaptive.record(
            Quality::FULL,
            &workload(),
            FrameTime { created: true, moving: false, ..moving(500.0) },
        );
        adaptive.moved(Instant::now());
        assert_ne!(
            adaptive.quality(Instant::now(), &workload()),
            Quality::FULL,
            "without another measurement it counts"
        );
    }

    #[test]
    fn the_full_frame_of_a_larger_window_is_measured_again() {
        let (mut adaptive, now) = (AdaptiveResolution::new(60.0), Instant::now());
        let small = Workload::new(8e3, [(0.0, 4e5)]);
        let rest = |ms, created| FrameTime { ms, moving: false, created };
        adaptive.record(Quality::FULL, &small, rest(5.0, false));
        adaptive.record(Quality::FULL, &workload(), rest(500.0, true));
        adaptive.moved(now);
        assert_ne!(adaptive.quality(now, &workload()), Quality::FULL);
    }

    #[test]
    fn after_repeated_slow_frames_the_patience_grows() {
        // Light for long enough that a finer quality is tried, and heavy for long enough that it fails.
        let load = |i: usize| if i % 60 < 30 { LOADS[0] } else { LOADS[1] };
        let frames = frames(&mut started(LOADS[1]), load, 1800);
        let slow = |part: &[(Quality, f64)]| part.iter().filter(|(_, time)| *time > 90.0).count();
        let [first, last] = [slow(&frames[..300]), slow(&frames[300..])];
        assert!(first > 0 && last == 0, "{first} at first, {last} later");
    }

    #[test]
    fn a_slow_quality_is_followed_by_one_without_more_pixels_or_surfels() {
        for load in LOADS {
            let mut adaptive = started(load);
            let work = workload();
            let all = || work.choices().map(|quality| (quality, load.time(quality)));
            (0..50).for_each(|_| {
                all().for_each(|(quality, ms)| adaptive.record(quality, &workload(), moving(ms)))
            });
            let slow: Vec<_> =
                all().filter(|(quality, _)| adaptive.expected(&workload(), *quality) > LIMIT).collect();
            for (chosen, _) in slow {
                adaptive.chosen = chosen;
                let next = adaptive.coarser(&workload());
                let is_less = |next: Quality| next.scale <= chosen.scale && next.lod >= chosen.lod;
                let fits = |quality| adaptive.expected(&workload(), quality) <= TARGET;
                let none = !all().any(|(quality, _)| is_less(quality) && fits(quality));
                assert!(none || is_less(next) && fits(next), "{chosen:?} {next:?}");
            }
        }
    }

    #[test]
    fn the_first_frames_of_a_slow_device_are_coarse_without_a_measurement() {
        let frames = frames(&mut AdaptiveResolution::new(60.0), |_| LOADS[1], 10);
        assert!(frames.iter().all(|(_, time)| *time <= 90.0), "{frames:?}");
    }

    #[test]
    fn a_scene_of_small_surfels_gets_fewer_and_one_of_large_surfels_fewer_pixels() {
        let load = Load { fixed: 5.0, pixels: 90.0, surfels: 35.0 };
        let chosen = |first: f64| {
            let mut adaptive = started(load);
            let (now, workload) = (Instant::now(), of_lods(first));
            adaptive.moved(now);
            for _ in 0..100 {
                let quality = adaptive.quality(now, &workload);
                adaptive.record(quality, &workload, moving(load.time_of(workload.work(quality))));
            }
            adaptive.quality(now, &workload)
        };
        let (small, large) = (chosen(1.0), chosen(20.0));
        assert!(small.lod > 0.0 && large.lod == 0.0 && small.scale > large.scale, "{small:?} {large:?}");
    }

    #[test]
    fn at_rest_a_frame_of_full_quality_is_due() {
        let (mut adaptive, now) = (started(LOADS[1]), Instant::now());
        assert_eq!((adaptive.quality(now, &workload()), adaptive.refine_at(now)), (Quality::FULL, None));
        adaptive.moved(now);
        assert_ne!(adaptive.quality(now, &workload()), Quality::FULL);
        let rests = adaptive.refine_at(now).unwrap();
        assert!(rests >= now + REST && rests <= now + 4 * REST);
        assert_eq!((adaptive.quality(rests, &workload()), adaptive.refine_at(rests)), (Quality::FULL, None));
    }
}
