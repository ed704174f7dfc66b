//! Soak test of a window: many frames, changes of size and of surfels.

/// So many frames have the same size.
const SIZE_EVERY: u64 = 20;
/// So many frames show the same surfels: changes of both fall together now and then, and mostly do not.
const SURFELS_EVERY: u64 = 25;
/// Frames of a soak test unless a number is given.
pub const FRAMES: u64 = 1000;

/// What comes before the next frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// Px that the window is to have.
    pub size: Option<[u32; 2]>,
    /// Whether the surfels are to be others.
    pub change: bool,
}

impl Step {
    /// All stays as it is.
    pub const STAY: Self = Self { size: None, change: false };
}

/// How far a soak is.
#[derive(Clone, Debug)]
pub struct Soak {
    frames: u64,
    drawn: u64,
    changes: u64,
    /// The size that was asked for and not seen yet.
    requested: Option<[u32; 2]>,
    /// How many sizes came, and how many did not before the next was asked for.
    taken: u64,
    missed: u64,
}

impl Soak {
    /// A soak of so many frames.
    pub fn new(frames: u64) -> Self {
        Self { frames, drawn: 0, changes: 0, requested: None, taken: 0, missed: 0 }
    }

    /// What comes after a frame of `size` px; `None` at the end.
    pub fn next(&mut self, size: [u32; 2]) -> Option<Step> {
        self.drawn += 1;
        self.taken += u64::from(self.requested.take_if(|requested| *requested == size).is_some());
        if self.drawn == self.frames {
            return None;
        }
        let size = self.drawn.is_multiple_of(SIZE_EVERY).then(|| size_of(self.drawn / SIZE_EVERY));
        if size.is_some() {
            self.missed += u64::from(std::mem::replace(&mut self.requested, size).is_some());
        }
        let change = self.drawn.is_multiple_of(SURFELS_EVERY);
        self.changes += u64::from(change);
        Some(Step { size, change })
    }

    /// What was seen; an error where the window did not follow.
    pub fn end(&self) -> Result<String, String> {
        // The last size may come after the end.
        let Self { drawn, taken, missed, changes, .. } = self;
        match missed {
            0 => Ok(format!("{drawn} frames, size changed {taken} times, surfels {changes} times")),
            _ => Err(format!("the window did not take {missed} of {} sizes", taken + missed)),
        }
    }
}

/// The sizes in turns, px; the smallest that there is among them.
fn size_of(turn: u64) -> [u32; 2] {
    let turn = turn as u32;
    match turn % 10 {
        3 => [1, 1],
        7 => [1, 90 + turn],
        _ => [160 + 37 * turn % 320, 120 + 53 * turn % 240],
    }
}
