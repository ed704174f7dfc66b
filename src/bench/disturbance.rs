//! Disturbances: why the times of a run may not be those of its work.

use super::record::{Clock, Run, Session, Time};

/// Share of the processors that other programs may keep busy; at least [`LEAST_OTHERS`] of a processor.
const OTHERS: f64 = 0.05;
const LEAST_OTHERS: f64 = 0.1;

/// Work per wall time that is out of line, relative to that of like runs. With two processors, runs are within ±10 % of each other.
const OUT_OF_LINE: f64 = 0.8;

/// Threads that a frame on processors keeps busy at least: one always works, but for what the system takes to wake another.
const LEAST_THREADS: f64 = 0.9;

/// Like runs are of the same method with a work within this factor.
const LIKE: f64 = 4.0;
/// Fewest like runs, with the run itself, for a comparison.
const FEWEST_LIKE: usize = 4;

/// Why the times of a run may not be those of its work.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Disturbance {
    /// Other programs kept so many logical processors busy, on average.
    Busy(f64),
    /// A frame waited: its wall time, ms, where its work would take the second value.
    Waited([f64; 2]),
}

/// The disturbances of a run of this session.
pub fn disturbances(session: &Session, run: &Run) -> Vec<Disturbance> {
    let Some(time) = &run.time else { return Vec::new() };
    let allowed = (OTHERS * session.provenance.host.cores as f64).max(LEAST_OTHERS);
    let busy = time.others.filter(|others| *others > allowed).map(Disturbance::Busy);
    busy.into_iter().chain(waited(session, run, time)).collect()
}

/// Compares work per wall time with the median of like runs; work on processors also with a single thread.
fn waited(session: &Session, run: &Run, time: &Time) -> Option<Disturbance> {
    let own = concurrency(time)?;
    let like = session.runs.iter().filter(|other| other.implementation.method == run.implementation.method);
    let like = like.filter_map(|other| other.time.as_ref()).filter(|other| {
        let factor = other.work().median / time.work().median;
        other.clock == time.clock && (1.0 / LIKE..=LIKE).contains(&factor)
    });
    let mut of_like: Vec<f64> = like.filter_map(concurrency).collect();
    of_like.sort_by(f64::total_cmp);
    let usual = (of_like.len() >= FEWEST_LIKE).then(|| of_like[of_like.len() / 2]);
    let least = if time.clock == Clock::Cpu { LEAST_THREADS } else { 0.0 };
    let expected = match usual {
        Some(usual) if own < OUT_OF_LINE * usual => usual,
        _ if own < least => 1.0,
        _ => return None,
    };
    Some(Disturbance::Waited([time.wall.median, time.work().median / expected]))
}

/// Work per wall time: of processors, the mean number of busy threads.
fn concurrency(time: &Time) -> Option<f64> {
    Some(time.work().median / time.wall.median).filter(|value| value.is_finite() && *value > 0.0)
}
