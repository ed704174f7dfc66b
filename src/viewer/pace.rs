//! How fine pictures are while the hands move: as fine as frames keep to their time, and whole when they rest.

use std::time::{Duration, Instant};

/// Sides of the pictures, parts of the window's.
const SIDES: [f64; 5] = [1.0, 0.75, 0.5, 0.375, 0.25];
/// How long the hands rest before the picture is whole.
const REST: Duration = Duration::from_millis(180);
/// How many frames have to leave time before they are finer: a single quick one may be chance.
const PATIENCE: u32 = 3;

/// Chooses how fine frames are.
#[derive(Clone, Copy, Debug)]
pub struct Pace {
    /// Of a frame while the hands move, ms.
    budget: f64,
    /// In [`SIDES`].
    level: usize,
    moved: Option<Instant>,
    /// Frames in a row that left time for finer ones.
    quick: u32,
}

impl Pace {
    /// Frames may take so long, ms.
    pub fn new(budget: f64) -> Self {
        Self { budget, level: 0, moved: None, quick: 0 }
    }

    /// The hands move.
    pub fn moved(&mut self, now: Instant) {
        self.moved = Some(now);
    }

    /// The side of a frame that begins now, as part of the window's.
    pub fn side(&self, now: Instant) -> f64 {
        if self.moves(now) { SIDES[self.level] } else { 1.0 }
    }

    fn moves(&self, now: Instant) -> bool {
        self.moved.is_some_and(|moved| now < moved + REST)
    }

    /// When the picture is to be drawn once more, whole.
    pub fn refines(&self, now: Instant) -> Option<Instant> {
        let moved = self.moved.filter(|_| self.level > 0)?;
        (now < moved + REST).then_some(moved + REST)
    }

    /// A frame of this side took so long, ms.
    pub fn took(&mut self, side: f64, ms: f64) {
        let ratio = ms / self.budget;
        if side != SIDES[self.level] {
            // Of a whole one, what would do.
            if side == 1.0 && ratio > 1.0 {
                self.level =
                    SIDES.iter().position(|side| side * side * ratio <= 1.0).unwrap_or(SIDES.len() - 1);
            }
            return;
        }
        let finer = SIDES[self.level.saturating_sub(1)] / SIDES[self.level];
        self.quick = if ratio * finer * finer < 0.9 { self.quick + 1 } else { 0 };
        if ratio > 1.2 {
            (self.level, self.quick) = ((self.level + 1).min(SIDES.len() - 1), 0);
        } else if self.quick >= PATIENCE && self.level > 0 {
            (self.level, self.quick) = (self.level - 1, 0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The side that frames come to, each of which takes `fixed` and `whole` times its pixels, ms.
    fn settled(fixed: f64, whole: f64) -> (f64, f64) {
        let (mut pace, now) = (Pace::new(60.0), Instant::now());
        pace.moved(now);
        let time = |side: f64| fixed + whole * side * side;
        for _ in 0..50 {
            let side = pace.side(now);
            pace.took(side, time(side));
        }
        let side = pace.side(now);
        (side, time(side))
    }

    #[test]
    fn moving_frames_come_to_keep_their_time_and_are_no_coarser_than_that_takes() {
        assert_eq!(settled(5.0, 30.0).0, 1.0);
        for (fixed, whole) in [(10.0, 100.0), (30.0, 200.0), (0.0, 900.0)] {
            let (side, time) = settled(fixed, whole);
            assert!(time <= 72.0, "{fixed} {whole}: {side} {time}");
        }
        assert_eq!(settled(500.0, 500.0).0, 0.25, "as coarse as there is");
    }

    #[test]
    fn what_rests_is_whole_and_drawn_once_more() {
        let (mut pace, now) = (Pace::new(10.0), Instant::now());
        assert_eq!((pace.side(now), pace.refines(now)), (1.0, None));
        pace.took(1.0, 100.0);
        pace.moved(now);
        assert!(pace.side(now) < 0.4);
        assert_eq!(pace.refines(now), Some(now + REST));
        let later = now + 2 * REST;
        assert_eq!((pace.side(later), pace.refines(later)), (1.0, None));
    }
}
