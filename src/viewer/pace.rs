//! How fine pictures are while the hands move: as fine as frames keep to their time, and whole when they rest.

use super::cost::{Cost, Work};
use std::time::{Duration, Instant};

/// Sides of the pictures, parts of the whole one's: each has 1.6 times the pixels of the next one, so that no step to a finer picture makes a
/// frame that keeps to its time exceed it by half.
const SIDES: [f64; 7] = [1.0, 0.8, 0.63, 0.5, 0.4, 0.32, LEAST_SIDE];
/// The least of them: below it a picture tells nothing.
pub const LEAST_SIDE: f64 = 0.25;
/// How long the hands rest at least before the picture is whole.
const REST: Duration = Duration::from_millis(180);
/// Part of the budget that a frame may be expected to take as it is chosen: the rest is for what no frame before has told.
const AIM: f64 = 0.8;
/// And beyond which another is chosen.
const MOST: f64 = 1.0;
/// And that one has to keep to for a finer one to be next, which takes 1.6 times as long at most.
const ROOM: f64 = 0.9;
/// How many frames in a row have to leave time before they are finer: a single quick one may be chance.
const PATIENCE: u32 = 4;
/// The same where finer ones have turned out too slow again and again.
const MOST_PATIENCE: u32 = 64;
/// After so many frames a finer choice has proved good.
const PROVED: u32 = 40;
/// A finer picture has at most this part of the other's blur.
const FINER: f64 = 0.97;

/// How fine a frame is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quality {
    /// Side of the picture, as part of the whole one's.
    pub side: f64,
    /// Which of the scenes: 0 has all surfels, each further one fewer.
    pub scene: usize,
}

impl Quality {
    /// Every pixel and every surfel.
    pub const WHOLE: Self = Self { side: 1.0, scene: 0 };

    /// Whether it has a step more of surfels or of pixels at most: what frames took tells what others like them will.
    fn is_next_to(&self, other: Self) -> bool {
        let step = |side: f64| SIDES.iter().position(|one| *one == side).unwrap_or(0);
        let [pixels, surfels] =
            [step(other.side).saturating_sub(step(self.side)), other.scene.saturating_sub(self.scene)];
        pixels + surfels <= 1
    }
}

/// What there is to be seen.
#[derive(Clone, Debug)]
pub struct Sight {
    /// Pixels of the window's picture.
    pub pixels: f64,
    /// Surfels of the whole scene, and of each coarser one.
    pub surfels: Vec<f64>,
    /// Diameter of the scene in the picture, px.
    pub across: f64,
}

impl Sight {
    fn work(&self, Quality { side, scene }: Quality) -> Work {
        let surfels = self.surfels.get(scene).or(self.surfels.last());
        Work { pixels: self.pixels * side * side, surfels: surfels.copied().unwrap_or(0.0) }
    }

    /// How far apart the details are that a picture can show, px of the window's: those of its pixels, and those of its surfels.
    fn blur(&self, quality: Quality) -> f64 {
        // As on a ball, that has half of them on this side.
        let apart = self.across * (0.5 * std::f64::consts::PI / self.work(quality).surfels.max(1.0)).sqrt();
        (1.0 / quality.side).hypot(apart)
    }

    fn choices(&self) -> impl Iterator<Item = Quality> + use<> {
        let scenes = self.surfels.len().max(1);
        (0..scenes).flat_map(|scene| SIDES.map(|side| Quality { side, scene }))
    }
}

/// What a frame took.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// How long, ms.
    pub ms: f64,
    /// Whether the hands moved.
    pub moving: bool,
    /// Whether targets or buffers had to be made for it.
    pub made: bool,
}

/// Chooses how fine frames are.
#[derive(Clone, Debug)]
pub struct Pace {
    /// Of a frame while the hands move, ms.
    budget: f64,
    cost: Cost,
    /// Whether a frame told what it costs while the hands moved: then whole ones tell nothing new.
    moving_known: bool,
    /// What a whole frame had to do and took, ms, which does not tell whether for its pixels or its surfels.
    whole: Option<(Work, f64)>,
    chosen: Quality,
    moved: Option<Instant>,
    /// How long the last frame while the hands moved took, ms.
    last: f64,
    /// What was chosen until a frame took too long, which may have been other programs' doing.
    good: Option<Quality>,
    /// Frames in a row that left time for finer ones.
    quick: u32,
    patience: u32,
    /// Frames since finer ones were chosen.
    since: u32,
}

impl Pace {
    /// Frames may take so long, ms.
    pub fn new(budget: f64) -> Self {
        Self {
            budget,
            cost: Cost::default(),
            moving_known: false,
            whole: None,
            chosen: Quality::WHOLE,
            moved: None,
            last: 0.0,
            good: None,
            quick: 0,
            patience: PATIENCE,
            since: PROVED,
        }
    }

    /// Something else is shown, or otherwise: what frames took tells nothing any more.
    pub fn forget(&mut self) {
        *self = Self { moved: self.moved, ..Self::new(self.budget) };
    }

    /// Whether a frame has told what it costs.
    pub fn is_known(&self) -> bool {
        self.whole.is_some() || self.moving_known
    }

    /// The hands move.
    pub fn moved(&mut self, now: Instant) {
        self.moved = Some(now);
    }

    /// How fine a frame is that begins now.
    pub fn quality(&mut self, now: Instant, sight: &Sight) -> Quality {
        if !self.moves(now) {
            return Quality::WHOLE;
        }
        self.choose(sight);
        self.chosen
    }

    /// Whether the hands move.
    pub fn moves(&self, now: Instant) -> bool {
        self.moved.is_some_and(|moved| now < moved + self.rest())
    }

    /// Who rests for a moment only is not made to wait for a whole frame.
    fn rest(&self) -> Duration {
        REST.max(Duration::from_secs_f64(1e-3 * self.whole.map_or(0.0, |(_, ms)| ms)).min(4 * REST))
    }

    /// When the picture is to be drawn once more, whole.
    pub fn refines(&self, now: Instant) -> Option<Instant> {
        let rests = self.moved? + self.rest();
        (self.chosen != Quality::WHOLE && now < rests).then_some(rests)
    }

    /// What a frame took.
    pub fn took(&mut self, quality: Quality, sight: &Sight, Frame { ms, moving, made }: Frame) {
        let known = self.moving_known || self.whole.is_some();
        if !moving && quality == Quality::WHOLE {
            let work = sight.work(quality);
            let like = self.whole.filter(|(known, _)| made && *known == work);
            self.whole = Some((work, ms.clamp(0.0, 1e6).min(like.map_or(f64::INFINITY, |(_, ms)| ms))));
        }
        // The next one like it tells what it takes without that.
        if made && known {
            return;
        }
        let work = sight.work(quality);
        if let Some((of, whole)) = self.whole.filter(|_| moving) {
            // The two together tell pixels from surfels; if the device has more to do than it had, it would have for that, too.
            let busier = (ms / self.cost.of(work)).max(1.0);
            self.cost.learn(of, busier * whole);
        }
        if moving || !self.moving_known {
            self.cost.learn(work, ms);
        }
        (self.moving_known, self.last) = (self.moving_known || moving, ms);
    }

    fn expected(&self, sight: &Sight, quality: Quality) -> f64 {
        let (work, whole) = (sight.work(quality), sight.work(Quality::WHOLE));
        let part = (work.pixels / whole.pixels).max(work.surfels / whole.surfels.max(1.0));
        let most = self.whole.filter(|_| !self.moving_known).map_or(0.0, |(_, whole)| part * whole);
        self.cost.of(work).max(most) / self.budget
    }

    /// Keeps to what was chosen, unless it is too slow, or finer frames have had time enough for long.
    fn choose(&mut self, sight: &Sight) {
        self.since = self.since.saturating_add(1);
        if self.since == PROVED {
            self.patience = (self.patience / 2).max(PATIENCE);
        }
        if self.chosen.scene >= sight.surfels.len().max(1) || self.expected(sight, self.chosen) > MOST {
            if self.since < PROVED {
                // What was finer did not last.
                (self.patience, self.since) = ((2 * self.patience).min(MOST_PATIENCE), PROVED);
            }
            self.good.get_or_insert(self.chosen);
            (self.chosen, self.quick) = (self.coarser(sight), 0);
            return;
        }
        let back = self.good.filter(|good| self.expected(sight, *good) <= AIM);
        let next = back.or_else(|| self.finest(sight, |quality| quality.is_next_to(self.chosen)));
        let finer = next.filter(|next| sight.blur(*next) < FINER * sight.blur(self.chosen));
        let finer = finer.filter(|_| self.last <= ROOM * self.budget);
        self.quick = if finer.is_some() { self.quick + 1 } else { 0 };
        if let Some(finer) = finer.filter(|_| self.quick >= self.patience) {
            (self.chosen, self.quick, self.since, self.good) = (finer, 0, 0, None);
        }
    }

    /// The finest that has no more of anything and should keep to its time; the quickest if none does.
    fn coarser(&self, sight: &Sight) -> Quality {
        let no_more =
            |quality: &Quality| quality.side <= self.chosen.side && quality.scene >= self.chosen.scene;
        let quickest = || least(sight.choices(), |quality| self.cost.of(sight.work(quality)));
        self.finest(sight, no_more).or_else(quickest).unwrap_or(Quality::WHOLE)
    }

    fn finest(&self, sight: &Sight, among: impl Fn(&Quality) -> bool) -> Option<Quality> {
        let fits = |quality: &Quality| self.expected(sight, *quality) <= AIM;
        least(sight.choices().filter(among).filter(fits), |quality| sight.blur(quality))
    }
}

/// What has the least value.
fn least(choices: impl Iterator<Item = Quality>, value: impl Fn(Quality) -> f64) -> Option<Quality> {
    choices.min_by(|a, b| value(*a).total_cmp(&value(*b)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sight() -> Sight {
        let surfels = (0..11).map(|scene| 4e5 / 1.6f64.powi(scene)).collect();
        Sight { pixels: 8e5, surfels, across: 700.0 }
    }

    /// A device on which frames take these, ms: always, all pixels, all surfels; and whose pixels take longer, the fewer surfels there are.
    #[derive(Clone, Copy)]
    struct Load {
        fixed: f64,
        pixels: f64,
        surfels: f64,
    }

    impl Load {
        fn time(&self, quality: Quality) -> f64 {
            let work = sight().work(quality);
            let fewer = 1.0 + 0.05 * quality.scene as f64;
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

    /// A frame while the hands move.
    fn of(ms: f64) -> Frame {
        Frame { ms, moving: true, made: false }
    }

    /// The qualities and times of `count` frames while the hands move.
    fn frames(pace: &mut Pace, load: impl Fn(usize) -> Load, count: usize) -> Vec<(Quality, f64)> {
        let now = Instant::now();
        pace.moved(now);
        let mut frame = |i: usize| {
            let quality = pace.quality(now, &sight());
            let time = load(i).time(quality);
            pace.took(quality, &sight(), of(time));
            (quality, time)
        };
        (0..count).map(&mut frame).collect()
    }

    /// A pace that has seen the whole picture, as the first one is.
    fn started(load: Load) -> Pace {
        let mut pace = Pace::new(60.0);
        pace.took(Quality::WHOLE, &sight(), Frame { moving: false, ..of(load.time(Quality::WHOLE)) });
        pace
    }

    #[test]
    fn moving_frames_keep_to_their_time_from_the_first_and_come_to_rest() {
        for load in LOADS {
            let frames = frames(&mut started(load), |_| load, 400);
            for (i, (_, time)) in frames.iter().enumerate() {
                assert!(*time <= 90.0, "{:?}", &frames[..=i]);
            }
            let changes = frames[200..].windows(2).filter(|pair| pair[0].0 != pair[1].0).count();
            assert!(changes <= 2, "{changes} changes");
            let (last, time) = frames[399];
            let finer = sight().choices().filter(|q| sight().blur(*q) < 0.7 * sight().blur(last));
            let best = finer.map(|quality| load.time(quality)).fold(f64::INFINITY, f64::min);
            assert!(best > 0.8 * 60.0, "{last:?} of {time} ms, a finer one takes {best}");
        }
    }

    #[test]
    fn what_is_quick_enough_is_whole() {
        let load = LOADS[0];
        assert!(
            frames(&mut started(load), |_| load, 50).iter().all(|(quality, _)| *quality == Quality::WHOLE)
        );
        assert_eq!(started(load).refines(Instant::now()), None);
    }

    #[test]
    fn another_load_is_met_by_the_next_frame_and_what_is_free_again_is_used() {
        let (light, heavy) = (LOADS[0], LOADS[1]);
        let load = |i| if (50..100).contains(&i) { heavy } else { light };
        let frames = frames(&mut started(light), load, 300);
        assert!(frames[50].1 > 90.0, "nothing could tell");
        let slow = frames[51..].iter().position(|(_, time)| *time > 90.0);
        assert_eq!(slow.map(|slow| &frames[48 + slow..52 + slow]), None);
        assert_eq!(frames[160].0, Quality::WHOLE);
    }

    #[test]
    fn a_load_that_comes_and_goes_makes_finer_frames_ever_rarer() {
        let load = |i: usize| if i % 8 < 4 { LOADS[0] } else { LOADS[1] };
        let frames = frames(&mut started(LOADS[1]), load, 800);
        let slow = |part: &[(Quality, f64)]| part.iter().filter(|(_, time)| *time > 90.0).count();
        assert!(slow(&frames[400..]) <= 8, "{}", slow(&frames[400..]));
    }

    #[test]
    fn what_making_things_takes_tells_nothing_of_frames() {
        for load in LOADS {
            let choices = |making: f64| {
                let mut pace = Pace::new(60.0);
                let whole = load.time(Quality::WHOLE);
                for (ms, made) in [(whole, false), (whole + making, true)] {
                    pace.took(Quality::WHOLE, &sight(), Frame { ms, moving: false, made });
                }
                let (now, mut before) = (Instant::now(), Quality::WHOLE);
                pace.moved(now);
                let mut frame = |_| {
                    let quality = pace.quality(now, &sight());
                    let made = std::mem::replace(&mut before, quality) != quality;
                    let ms = load.time(quality) + if made { making } else { 0.0 };
                    pace.took(quality, &sight(), Frame { made, ..of(ms) });
                    quality
                };
                (0..200).map(&mut frame).collect::<Vec<_>>()
            };
            let other = choices(0.0).into_iter().zip(choices(200.0)).position(|(one, other)| one != other);
            assert_eq!(other, None);
        }
        let mut pace = Pace::new(60.0);
        pace.took(Quality::WHOLE, &sight(), Frame { made: true, moving: false, ..of(500.0) });
        pace.moved(Instant::now());
        assert_ne!(
            pace.quality(Instant::now(), &sight()),
            Quality::WHOLE,
            "where nothing else is known, it is believed"
        );
    }

    #[test]
    fn a_larger_window_has_whole_frames_of_its_own() {
        let (mut pace, now) = (Pace::new(60.0), Instant::now());
        let small = Sight { pixels: 0.01 * sight().pixels, ..sight() };
        let rest = |ms, made| Frame { ms, moving: false, made };
        pace.took(Quality::WHOLE, &small, rest(5.0, false));
        pace.took(Quality::WHOLE, &sight(), rest(500.0, true));
        pace.moved(now);
        assert_ne!(pace.quality(now, &sight()), Quality::WHOLE);
    }

    #[test]
    fn who_was_too_slow_again_and_again_waits_ever_longer() {
        // Light for long enough that it is tried, and heavy for long enough that it fails.
        let load = |i: usize| if i % 60 < 30 { LOADS[0] } else { LOADS[1] };
        let frames = frames(&mut started(LOADS[1]), load, 1800);
        let slow = |part: &[(Quality, f64)]| part.iter().filter(|(_, time)| *time > 90.0).count();
        let [first, last] = [slow(&frames[..300]), slow(&frames[300..])];
        assert!(first > 0 && last == 0, "{first} at first, {last} later");
    }

    #[test]
    fn what_is_too_slow_gets_less_and_more_of_nothing() {
        for load in LOADS {
            let mut pace = started(load);
            let all = || sight().choices().map(|quality| (quality, load.time(quality)));
            (0..50).for_each(|_| all().for_each(|(quality, ms)| pace.took(quality, &sight(), of(ms))));
            let slow: Vec<_> =
                all().filter(|(quality, _)| pace.expected(&sight(), *quality) > MOST).collect();
            for (chosen, _) in slow {
                pace.chosen = chosen;
                let next = pace.coarser(&sight());
                let is_less = |next: Quality| next.side <= chosen.side && next.scene >= chosen.scene;
                let fits = |quality| pace.expected(&sight(), quality) <= AIM;
                let none = !all().any(|(quality, _)| is_less(quality) && fits(quality));
                assert!(none || is_less(next) && fits(next), "{chosen:?} {next:?}");
            }
        }
    }

    #[test]
    fn the_first_frames_of_a_slow_device_are_coarse_even_if_none_was_before() {
        let frames = frames(&mut Pace::new(60.0), |_| LOADS[1], 10);
        assert!(frames.iter().all(|(_, time)| *time <= 90.0), "{frames:?}");
    }

    #[test]
    fn few_surfels_serve_where_they_are_small_and_few_pixels_where_surfels_are_large() {
        let load = Load { fixed: 5.0, pixels: 60.0, surfels: 60.0 };
        let chosen = |across: f64| {
            let mut pace = started(load);
            let (now, sight) = (Instant::now(), Sight { across, ..sight() });
            pace.moved(now);
            for _ in 0..100 {
                let quality = pace.quality(now, &sight);
                pace.took(quality, &sight, of(load.time(quality)));
            }
            pace.quality(now, &sight)
        };
        let (far, near) = (chosen(150.0), chosen(20_000.0));
        assert!(far.scene > near.scene && far.side > near.side, "{far:?} {near:?}");
    }

    #[test]
    fn what_rests_is_whole_and_drawn_once_more() {
        let (mut pace, now) = (started(LOADS[1]), Instant::now());
        assert_eq!((pace.quality(now, &sight()), pace.refines(now)), (Quality::WHOLE, None));
        pace.moved(now);
        assert_ne!(pace.quality(now, &sight()), Quality::WHOLE);
        let rests = pace.refines(now).unwrap();
        assert!(rests >= now + REST && rests <= now + 4 * REST);
        assert_eq!((pace.quality(rests, &sight()), pace.refines(rests)), (Quality::WHOLE, None));
    }
}
