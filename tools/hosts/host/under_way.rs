//! Frames in flight.

use super::{Host, Result, Submitted};
use ash::vk;
use std::collections::VecDeque;

/// A limited number of frames in flight.
pub struct UnderWay {
    most: usize,
    frames: VecDeque<Submitted>,
}

impl UnderWay {
    /// No frames yet, at most `most`.
    pub fn new(most: u32) -> Self {
        Self { most: most as usize, frames: VecDeque::new() }
    }

    /// Records and submits a frame, once the GPU has finished all but the last.
    pub fn submit<T>(&mut self, host: &Host, body: impl FnOnce(vk::CommandBuffer) -> Result<T>) -> Result<T> {
        while self.is_full() {
            self.wait(host)?;
        }
        let (submitted, made) = host.submit(body)?;
        self.frames.push_back(submitted);
        Ok(made)
    }

    /// Whether the next frame must wait for the oldest.
    pub fn is_full(&self) -> bool {
        self.frames.len() >= self.most
    }

    /// Waits for the oldest frame; returns whether there was one.
    pub fn wait(&mut self, host: &Host) -> Result<bool> {
        let oldest = self.frames.pop_front();
        let is_some = oldest.is_some();
        oldest.map_or(Ok(()), |oldest| host.wait(oldest))?;
        Ok(is_some)
    }

    /// Waits for all frames.
    pub fn finish(&mut self, host: &Host) -> Result<()> {
        while self.wait(host)? {}
        Ok(())
    }
}
