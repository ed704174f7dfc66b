//! Soak test of a window: many frames, changes of size and of surfels.

/// Number of frames of one size.
const SIZE_EVERY: u64 = 20;
/// Number of frames with the same surfels: both changes coincide only now and then.
const SURFELS_EVERY: u64 = 25;
/// Default number of frames.
pub const FRAMES: u64 = 1000;

/// Actions before the next frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Step {
    /// New size of the window, px.
    pub size: Option<[u32; 2]>,
    /// Whether to change the surfels.
    pub change: bool,
}

impl Step {
    /// No change.
    pub const STAY: Self = Self { size: None, change: false };
}

/// State of a soak test.
#[derive(Clone, Debug)]
pub struct Soak {
    frames: u64,
    drawn: u64,
    changes: u64,
    /// The requested size, until it arrives.
    requested: Option<[u32; 2]>,
    /// Number of sizes that arrived, and of those that did not before the next request.
    taken: u64,
    missed: u64,
}

impl Soak {
    /// A soak test of `frames` frames.
    pub fn new(frames: u64) -> Self {
        Self { frames, drawn: 0, changes: 0, requested: None, taken: 0, missed: 0 }
    }

    /// The actions after a frame of `size` px; `None` at the end.
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

    /// Summary; an error if the window did not follow.
    pub fn end(&self) -> Result<String, String> {
        // The last size may arrive after the end.
        let Self { drawn, taken, missed, changes, .. } = self;
        match missed {
            0 => Ok(format!("{drawn} frames, size changed {taken} times, surfels {changes} times")),
            _ => Err(format!("the window did not take {missed} of {} sizes", taken + missed)),
        }
    }
}

/// The size of a turn, px; includes the smallest one.
fn size_of(turn: u64) -> [u32; 2] {
    let turn = turn as u32;
    match turn % 10 {
        3 => [1, 1],
        7 => [1, 90 + turn],
        _ => [160 + 37 * turn % 320, 120 + 53 * turn % 240],
    }
}
