//! Times of the same runs on several machines.

use super::format;
use super::record::{Clock, Results, Run, Session, Time};
use crate::frame::times::{Interval, Statistics};
use glam::DVec3;

/// A machine, with its sessions by one version of the program.
pub struct Machine<'a> {
    /// In the order of the results.
    pub sessions: Vec<&'a Session>,
}

/// A run with its times on each machine.
pub struct Row<'a> {
    /// The run on the first of the machines that have it.
    pub run: &'a Run,
    /// Its times, machine by machine.
    pub times: Vec<Option<&'a Time>>,
}

/// How many times as fast a machine is as another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Speed {
    /// Quotient of the medians.
    pub median: f64,
    /// Contains this quotient wherever both medians are within their own 95 % intervals. None unless both have one.
    pub interval: Option<[f64; 2]>,
}

impl<'a> Machine<'a> {
    /// The machines of some results: those with another processor, memory, device, driver or program are different.
    pub fn all(results: &'a Results) -> Vec<Self> {
        let mut machines: Vec<Self> = Vec::new();
        for session in &results.sessions {
            match machines.iter_mut().find(|known| is_same(known.sessions[0], session)) {
                Some(known) => known.sessions.push(session),
                None => machines.push(Self { sessions: vec![session] }),
            }
        }
        machines
    }

    /// Its first session: all have its device, driver and host.
    pub fn first(&self) -> &'a Session {
        self.sessions[0]
    }

    /// Its timed runs with their times.
    fn timed(&self) -> impl Iterator<Item = (&'a Run, &'a Time)> + use<'a> {
        let all: Vec<&'a Run> = self.sessions.iter().flat_map(|session| &session.runs).collect();
        all.into_iter().filter(|run| run.ms().is_some()).filter_map(|run| Some((run, run.time.as_ref()?)))
    }
}

fn is_same(a: &Session, b: &Session) -> bool {
    let key = |session: &Session| {
        let provenance = &session.provenance;
        (provenance.host.clone(), provenance.device.clone(), provenance.code.clone())
    };
    key(a) == key(b)
}

/// What makes runs comparable, beside their viewpoints: the suite may differ.
fn key(run: &Run) -> impl PartialEq + use<> {
    let overlap = run.overlap.map(|overlap| format::significant(overlap, 3));
    let what = (run.experiment, run.paper_item.clone(), run.scene.clone(), run.points, run.size, overlap);
    (what, run.implementation.clone(), run.settings.clone())
}

/// Lengths relative to the distance of the point looked at, below which viewpoints are the same: machines round angles differently.
const SAME: f64 = 1e-6;

/// Whether both are seen from the same viewpoint.
fn is_same_view(a: &Run, b: &Run) -> bool {
    let (Some(a), Some(b)) = (&a.viewpoint, &b.viewpoint) else { return a.viewpoint == b.viewpoint };
    let distance = |a: [f64; 3], b: [f64; 3]| DVec3::from(a).distance(DVec3::from(b));
    let near = SAME * distance(a.eye, a.target);
    let is_near = distance(a.eye, b.eye) <= near && distance(a.target, b.target) <= near;
    is_near && distance(a.up, b.up) <= SAME && (&a.place, a.fov_y_deg) == (&b.place, b.fov_y_deg)
}

/// The timed runs that at least two of the machines have, in the order of the first machine with each.
pub fn rows<'a>(machines: &[Machine<'a>]) -> Vec<Row<'a>> {
    let mut rows: Vec<(_, Row<'a>)> = Vec::new();
    for (place, machine) in machines.iter().enumerate() {
        for (run, time) in machine.timed() {
            let key = key(run);
            let known = rows.iter().position(|(other, row)| *other == key && is_same_view(row.run, run));
            let known = known.unwrap_or_else(|| {
                rows.push((key, Row { run, times: vec![None; machines.len()] }));
                rows.len() - 1
            });
            rows[known].1.times[place].get_or_insert(time);
        }
    }
    let is_common = |row: &Row<'_>| row.times.iter().flatten().count() > 1;
    rows.into_iter().map(|(_, row)| row).filter(is_common).collect()
}

impl Row<'_> {
    /// Time of a frame on a machine: its [work](Time::work) if all machines have the same clock, otherwise the wall time, which they have in common.
    /// None if it was not timed.
    pub fn time(&self, machine: usize) -> Option<Statistics> {
        let mut clocks = self.times.iter().flatten().map(|time| time.clock);
        let first = clocks.next();
        let is_common = clocks.all(|clock| Some(clock) == first);
        let time = self.times.get(machine).copied().flatten()?;
        Some(time.by(if is_common { time.clock } else { Clock::Wall }))
    }

    /// How many times as fast a machine is as the first. None if one was not timed.
    pub fn speed(&self, machine: usize) -> Option<Speed> {
        quotient(&self.time(0)?, &self.time(machine)?)
    }
}

fn quotient(a: &Statistics, b: &Statistics) -> Option<Speed> {
    let is_usable = |value: &f64| value.is_finite() && *value > 0.0;
    let quotient = |a: f64, b: f64| Some(a / b).filter(is_usable);
    let ends = a.interval.zip(b.interval);
    let interval = ends.and_then(|([low, high], [other_low, other_high])| {
        Some([quotient(low, other_high)?, quotient(high, other_low)?])
    });
    Some(Speed { median: quotient(a.median, b.median)?, interval })
}

/// Geometric mean, least and greatest of some speeds; none without any.
pub fn mean(speeds: impl Iterator<Item = Speed>) -> Option<(usize, Interval)> {
    let medians: Vec<f64> = speeds.map(|speed| speed.median).collect();
    let mean = (medians.iter().map(|value| value.ln()).sum::<f64>() / medians.len() as f64).exp();
    let low = medians.iter().copied().reduce(f64::min)?;
    let high = medians.iter().copied().reduce(f64::max)?;
    Some((medians.len(), Interval { median: mean, low, high }))
}
