//! Adaptive resolution: while the camera moves, frames are as fine as the time budget allows; at rest they have full quality.

use super::quality::{Quality, Workload};
use std::time::{Duration, Instant};

/// How long the camera rests, at least, before a frame of full quality is rendered.
const REST: Duration = Duration::from_millis(180);
/// Part of the budget that a newly chosen quality may be expected to take; the rest absorbs errors of the estimate.
const TARGET: f64 = 0.8;
/// Part of the budget that the next finer quality may be expected to take if it was never measured.
const NEXT_TARGET: f64 = 0.9;
/// The same for finer ones than the next.
const FAR_TARGET: f64 = 0.7;
/// Expected part of the budget above which frames are too slow: a coarser quality is chosen after [`SLOW_FRAMES`] of them.
const LIMIT: f64 = 1.0;
/// The same, for the next frame.
const URGENT: f64 = 1.5;
/// A few frames may take longer by chance.
const SLOW_FRAMES: u32 = 3;
/// How many frames in a row must leave time before the quality becomes finer: a single fast frame may be chance.
const PATIENCE: u32 = 4;
/// The greatest number of such frames, after finer qualities were too slow again and again.
const MAX_PATIENCE: u32 = 512;
/// Number of frames after which a finer quality counts as stable.
const STABLE_FRAMES: u32 = 40;
/// Number of frames without a finer quality after which the patience is halved.
const FORGIVING_FRAMES: u32 = 1000;
/// How many times as long a quality waits whose known time does not fit the budget, though the present one's suggests that it does.
const DOUBT: u32 = 4;
/// Number of frames of a quality after which its factor is known: from then on, times tell the load.
const KNOWN_FRAMES: f64 = 4.0;

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

/// Time of a quality relative to [`Workload::typical_ms`] and to the load.
#[derive(Clone, Copy, Debug)]
struct Factor {
    quality: Quality,
    factor: f64,
    /// Number of frames that it is the mean of.
    frames: f64,
}

/// Chooses the quality of each frame from the times of earlier ones.
#[derive(Clone, Debug)]
pub struct AdaptiveResolution {
    /// Time budget of a frame while the camera moves, ms.
    budget: f64,
    /// Time of the last frames relative to what their qualities usually take: how slow the device is, with what else it has to do.
    load: f64,
    /// The qualities that were measured.
    factors: Vec<Factor>,
    /// Pixels of the window's picture at that time.
    pixels: f64,
    /// Time of the last frame of full quality at rest, ms.
    full_ms: Option<f64>,
    chosen: Quality,
    last_move: Option<Instant>,
    /// Frames in a row that were too slow.
    slow_frames: u32,
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
            load: 1.0,
            factors: Vec::new(),
            pixels: 0.0,
            full_ms: None,
            chosen: Quality::FULL,
            last_move: None,
            slow_frames: 0,
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
        !self.factors.is_empty()
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
        REST.max(Duration::from_secs_f64(1e-3 * self.full_ms.unwrap_or(0.0)).min(4 * REST))
    }

    /// When a frame of full quality is due, if the last one was coarser.
    pub fn refine_at(&self, now: Instant) -> Option<Instant> {
        let rests = self.last_move? + self.rest();
        (self.chosen != Quality::FULL && now < rests).then_some(rests)
    }

    /// Learns from the duration of a frame: first how long its quality takes, relative to others, and then how great the load is. Slower frames
    /// count in full, faster ones by half: the load of other programs varies.
    pub fn record(
        &mut self,
        quality: Quality,
        workload: &Workload,
        FrameTime { ms, moving, created }: FrameTime,
    ) {
        // A frame that created resources took longer for that: an earlier measurement holds, if there is one of as many pixels.
        let is_known = self.has_measured() && self.pixels == workload.pixels();
        if !ms.is_finite() || created && is_known {
            return;
        }
        self.pixels = workload.pixels();
        if !moving && quality == Quality::FULL {
            self.full_ms = Some(ms);
        }
        let measured = ms / workload.typical_ms(quality);
        if self.factors.is_empty() {
            self.load = measured;
        }
        let own = self.factors.iter().position(|known| known.quality == quality).unwrap_or_else(|| {
            self.factors.push(Factor { quality, factor: 0.0, frames: 0.0 });
            self.factors.len() - 1
        });
        let own = &mut self.factors[own];
        if own.frames < KNOWN_FRAMES {
            own.frames += 1.0;
            own.factor += (measured / self.load - own.factor) / own.frames;
        } else {
            let load = measured / own.factor;
            self.load = if load < self.load { 0.5 * (load + self.load) } else { load };
        }
    }

    /// Expected time of a frame, as part of the budget; that of a quality without a measurement by the most similar one with.
    fn expected(&self, workload: &Workload, quality: Quality) -> f64 {
        let typical = workload.typical_ms(quality);
        let distance = |known: &Factor| (workload.typical_ms(known.quality) / typical).ln().abs();
        let nearest = self.factors.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
        let own = self.factors.iter().find(|known| known.quality == quality).or(nearest);
        own.map_or(1.0, |known| known.factor) * self.load * typical / self.budget
    }

    /// Keeps the present quality unless it is too slow, or enough frames in a row have left time for a finer one.
    fn choose(&mut self, workload: &Workload) {
        self.frames_since_finer = self.frames_since_finer.saturating_add(1);
        if self.frames_since_finer.is_multiple_of(FORGIVING_FRAMES) {
            self.patience = (self.patience / 2).max(PATIENCE);
        }
        let expected = self.expected(workload, self.chosen);
        self.slow_frames = if expected > LIMIT { self.slow_frames + 1 } else { 0 };
        if expected > URGENT || self.slow_frames >= SLOW_FRAMES {
            if self.frames_since_finer < STABLE_FRAMES {
                // The finer quality did not last: the next one waits longer.
                self.patience = (2 * self.patience).min(MAX_PATIENCE);
                self.frames_since_finer = STABLE_FRAMES;
            }
            (self.chosen, self.slow_frames, self.fast_frames) = (self.coarser(workload), 0, 0);
            return;
        }
        let finer = self.finer(workload);
        self.fast_frames = if finer.is_some() { self.fast_frames + 1 } else { 0 };
        if let Some((finer, _)) = finer.filter(|(_, patience)| self.fast_frames >= *patience) {
            (self.chosen, self.fast_frames, self.frames_since_finer) = (finer, 0, 0);
        }
    }

    /// The finest of the coarser qualities that fits the budget; the coarsest of all if there is none.
    fn coarser(&self, workload: &Workload) -> Quality {
        let coarser = || workload.qualities().filter(|quality| self.chosen.is_finer_than(*quality));
        let fits = |quality: &Quality| self.expected(workload, *quality) <= TARGET;
        coarser().find(fits).or_else(|| coarser().next_back()).unwrap_or(self.chosen)
    }

    /// A finer quality that fits the budget, and how many frames in a row it has to do so: the finest one, if its time is known or far below;
    /// otherwise the next one, by the time of the present one. If that contradicts what is known, it waits longer.
    fn finer(&self, workload: &Workload) -> Option<(Quality, u32)> {
        let is_known = |quality: &Quality| self.factors.iter().any(|known| known.quality == *quality);
        let finer = || workload.qualities().filter(|quality| quality.is_finer_than(self.chosen));
        let fits = |quality: &Quality| {
            self.expected(workload, *quality) <= if is_known(quality) { TARGET } else { FAR_TARGET }
        };
        let of_typical = self.expected(workload, self.chosen) / workload.typical_ms(self.chosen);
        let next =
            || finer().next_back().filter(|next| of_typical * workload.typical_ms(*next) <= NEXT_TARGET);
        let certain = finer().find(fits).map(|quality| (quality, self.patience));
        certain.or_else(|| next().map(|next| (next, if is_known(&next) { DOUBT } else { 1 } * self.patience)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn workload() -> Workload {
        of_lods(2.0)
    }

    /// Eleven levels of detail of ever fewer surfels, of which the first after that of full quality is this, px.
    fn of_lods(first: f64) -> Workload {
        let level = |step: i32| if step == 0 { Quality::FULL.lod } else { first * 1.2f64.powi(step - 1) };
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
            self.time_of(quality, &workload())
        }

        fn time_of(&self, quality: Quality, workload: &Workload) -> f64 {
            let part = workload.surfels(quality) / 4e5;
            let fewer = 1.0 - 0.05 * part.ln() / 1.6f64.ln();
            let filter = if quality.filtered { 1.2 } else { 1.0 } * if quality.smooth { 1.0 } else { 0.7 };
            let scaling = if quality.scale < 1.0 { 0.1 * self.pixels } else { 0.0 };
            self.fixed + self.pixels * filter * fewer * quality.scale.powi(2) + scaling + self.surfels * part
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
            // The next but one, as the next may be expected to be slower than it is.
            let finer = workload().qualities().filter(|quality| quality.is_finer_than(last)).rev().nth(1);
            let next = finer.map_or(f64::INFINITY, |quality| load.time(quality));
            assert!(next > 0.8 * 60.0, "{last:?} of {time} ms, a finer one takes {next}");
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
    fn a_slow_quality_is_followed_by_a_coarser_one() {
        for load in LOADS {
            let (mut adaptive, all) = (started(load), workload().qualities().collect::<Vec<_>>());
            assert!(all.windows(2).all(|pair| pair[0].is_finer_than(pair[1])));
            for chosen in &all {
                adaptive.chosen = *chosen;
                for slowness in [1.0, 3.0, 100.0] {
                    adaptive.load = slowness;
                    let next = adaptive.coarser(&workload());
                    let fits = |quality: &Quality| adaptive.expected(&workload(), *quality) <= TARGET;
                    let none = !all.iter().any(|quality| chosen.is_finer_than(*quality) && fits(quality));
                    let is_coarser = chosen.is_finer_than(next) || Some(&next) == all.last();
                    assert!(is_coarser && (none || fits(&next)), "{chosen:?} {next:?}");
                }
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
                adaptive.record(quality, &workload, moving(load.time_of(quality, &workload)));
            }
            adaptive.quality(now, &workload)
        };
        let (small, large) = (chosen(1.1), chosen(20.0));
        let full = Quality::FULL.lod;
        assert!(small.lod > full && large.lod == full && small.scale > large.scale, "{small:?} {large:?}");
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
