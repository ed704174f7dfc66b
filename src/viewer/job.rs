//! Background job that reports its progress and can be cancelled.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use surfel::{Error, Progress, Result};

/// A background job.
pub struct Job<T> {
    state: Arc<JobState>,
    thread: Option<JoinHandle<Result<T>>>,
}

#[derive(Default)]
struct JobState {
    /// The stage, and which part of it is done, from 0 to 1.
    at: Mutex<(&'static str, f32)>,
    cancelled: AtomicBool,
}

impl Progress for JobState {
    fn at(&self, stage: &'static str, done: u64, total: u64) {
        let part = done as f32 / total.max(1) as f32;
        *self.at.lock().unwrap_or_else(PoisonError::into_inner) = (stage, part);
    }

    fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}

impl<T: Send + 'static> Job<T> {
    /// Starts the work on its own thread.
    pub fn start(work: impl FnOnce(&dyn Progress) -> Result<T> + Send + 'static) -> Self {
        let state = Arc::new(JobState::default());
        let own = state.clone();
        Self { state, thread: Some(thread::spawn(move || work(&*own))) }
    }

    /// The stage, and which part of it is done, from 0 to 1.
    pub fn at(&self) -> (&'static str, f32) {
        *self.state.at.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Cancels the job, which ends at its next check.
    pub fn cancel(&self) {
        self.state.cancelled.store(true, Ordering::Relaxed);
    }

    /// Takes the result once the job has ended.
    pub fn take(&mut self) -> Option<Result<T>> {
        let ended = self.thread.take_if(|thread| thread.is_finished())?;
        let panicked = |_| Err(Error::Usage("the background job panicked: see standard error".into()));
        Some(ended.join().unwrap_or_else(panicked))
    }
}

impl<T> Drop for Job<T> {
    /// Cancels the job and waits for it: it uses the device.
    fn drop(&mut self) {
        self.state.cancelled.store(true, Ordering::Relaxed);
        if let Some(thread) = self.thread.take() {
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn outcome<T: Send + 'static>(mut job: Job<T>) -> Result<T> {
        loop {
            if let Some(outcome) = job.take() {
                return outcome;
            }
            thread::yield_now();
        }
    }

    #[test]
    fn a_cancelled_job_ends_and_another_returns_its_result() {
        let endless = Job::<()>::start(|progress| {
            while !progress.is_cancelled() {
                thread::yield_now();
            }
            Err(Error::Cancelled)
        });
        endless.cancel();
        assert!(matches!(outcome(endless), Err(Error::Cancelled)));
        let done = Job::start(|progress| {
            progress.at("adding", 1, 4);
            Ok(1 + 1)
        });
        let state = done.state.clone();
        assert_eq!(outcome(done).unwrap(), 2);
        assert_eq!(*state.at.lock().unwrap(), ("adding", 0.25));
        assert!(outcome(Job::<()>::start(|_| panic!("on purpose"))).is_err());
    }
}
