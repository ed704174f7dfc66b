//! Deferred destruction: resources live until the frames in flight that may use them are over.

use crate::error::{Error, Result};
use crate::frame::resources::Deferred;
use crate::scene::{Instances, Scene};
use std::any::Any;
use std::collections::VecDeque;
use std::sync::Arc;

/// Maximum number of frames in flight.
const MOST: u32 = 64;

/// Resources that frames in flight may use.
pub(super) struct DeferredDestruction {
    /// Resources, each with the number of the last frame that may use it.
    list: VecDeque<(u64, Deferred)>,
    /// Scenes of the current frame.
    scenes: Vec<Arc<Scene>>,
    frame: u64,
    frames_in_flight: u64,
}

impl DeferredDestruction {
    /// An empty list for this number of frames in flight.
    pub(super) fn new(frames_in_flight: u32) -> Result<Self> {
        if !(1..=MOST).contains(&frames_in_flight) {
            return Err(Error::Usage(format!(
                "{frames_in_flight} frames in flight: the frame that is recorded is one of them, so give 1 or more, and at most {MOST}"
            )));
        }
        Ok(Self {
            list: VecDeque::new(),
            scenes: Vec::new(),
            frame: 0,
            frames_in_flight: frames_in_flight.into(),
        })
    }

    /// Destroys `resource` once the frames in flight, which may use it, are over.
    pub(super) fn defer(&mut self, resource: impl Any + Send + Sync) {
        self.extend([Box::new(resource) as Deferred]);
    }

    /// Keeps the scenes of a prepared frame; those of the frame before are deferred.
    pub(super) fn keep_scenes(&mut self, scenes: &Instances<'_>) {
        if !scenes.scenes().map(Arc::as_ptr).eq(self.scenes.iter().map(Arc::as_ptr)) {
            let old = std::mem::replace(&mut self.scenes, scenes.scenes().cloned().collect());
            self.defer(old);
        }
    }

    /// Defers the destruction of several resources.
    pub(super) fn extend(&mut self, resources: impl IntoIterator<Item = Deferred>) {
        let frame = self.frame;
        self.list.extend(resources.into_iter().map(|resource| (frame, resource)));
    }

    /// Destroys all resources and releases the scenes: every frame is over.
    pub(super) fn finish(&mut self) {
        self.list.clear();
        self.scenes.clear();
    }

    /// Begins a frame and destroys resources of frames that are over.
    pub(super) fn advance(&mut self) {
        self.frame += 1;
        while self.list.front().is_some_and(|(frame, _)| frame + self.frames_in_flight <= self.frame) {
            self.list.pop_front();
        }
    }
}
