//! Lengthy work on a thread of its own, which tells how far it has come and can be given up.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::{self, JoinHandle};
use surfel::{Error, Progress, Result};

/// Work under way.
pub struct Job<T> {
    state: Arc<JobState>,
    thread: Option<JoinHandle<Result<T>>>,
}

#[derive(Default)]
struct JobState {
    /// A stage, and how much of it is done.
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
    /// Begins it.
    pub fn start(work: impl FnOnce(&dyn Progress) -> Result<T> + Send + 'static) -> Self {
        let state = Arc::new(JobState::default());
        let own = state.clone();
        Self { state, thread: Some(thread::spawn(move || work(&*own))) }
    }

    /// A stage, and how much of it is done.
    pub fn at(&self) -> (&'static str, f32) {
        *self.state.at.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Has it given up, as soon as it looks.
    pub fn cancel(&self) {
        self.state.cancelled.store(true, Ordering::Relaxed);
    }

    /// What came of it, once it is over.
    pub fn take(&mut self) -> Option<Result<T>> {
        let over = self.thread.take_if(|thread| thread.is_finished())?;
        let died = |_| Err(Error::Usage("the work broke off: the log says where".into()));
        Some(over.join().unwrap_or_else(died))
    }
}

impl<T> Drop for Job<T> {
    /// It uses the device, which must not go before it.
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
    fn work_that_is_given_up_ends_and_other_work_is_done() {
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
