//! What frames under way may use, kept until they are over.

use crate::error::{Error, Result};
use crate::frame::resources::Outgoing;
use crate::scene::{Instances, Scene};
use std::any::Any;
use std::collections::VecDeque;
use std::sync::Arc;

/// Most frames under way: what each uses is kept.
const MOST: u32 = 64;

/// What frames under way may use.
pub(super) struct Held {
    /// Each with the number of the last frame that may use it.
    list: VecDeque<(u64, Outgoing)>,
    /// Those of the present frame.
    scenes: Vec<Arc<Scene>>,
    frame: u64,
    frames_in_flight: u64,
}

impl Held {
    /// Nothing yet; so many frames may be under way.
    pub(super) fn new(frames_in_flight: u32) -> Result<Self> {
        if !(1..=MOST).contains(&frames_in_flight) {
            return Err(Error::Usage(format!(
                "{frames_in_flight} frames in flight: a frame is under way when it is recorded, so give 1 or more, and at most {MOST}"
            )));
        }
        Ok(Self {
            list: VecDeque::new(),
            scenes: Vec::new(),
            frame: 0,
            frames_in_flight: frames_in_flight.into(),
        })
    }

    /// Keeps `held`, which frames so far may use.
    pub(super) fn hold(&mut self, held: impl Any + Send + Sync) {
        self.extend([Box::new(held) as Outgoing]);
    }

    /// Keeps the scenes of a frame that is prepared, in place of those of the frame before.
    pub(super) fn hold_scenes(&mut self, scenes: &Instances<'_>) {
        if !scenes.scenes().map(Arc::as_ptr).eq(self.scenes.iter().map(Arc::as_ptr)) {
            let old = std::mem::replace(&mut self.scenes, scenes.scenes().cloned().collect());
            self.hold(old);
        }
    }

    /// As [`Held::hold`].
    pub(super) fn extend(&mut self, held: impl IntoIterator<Item = Outgoing>) {
        let frame = self.frame;
        self.list.extend(held.into_iter().map(|held| (frame, held)));
    }

    /// Begins another frame, and lets go of what frames that are over have used.
    pub(super) fn advance(&mut self) {
        self.frame += 1;
        while self.list.front().is_some_and(|(frame, _)| frame + self.frames_in_flight <= self.frame) {
            self.list.pop_front();
        }
    }
}
