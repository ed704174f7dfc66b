//! Recommendations: the best setting for each budget of time or error.
//!
//! Candidates are the runs on the Pareto front: no other run is both faster and more exact. For a budget of time the
//! best run is the one of least error within it; for a budget of error, the fastest.

use super::group::grouped;
use super::record::{Experiment, Run, Session, View};
use crate::settings::methods::Method;

/// A run that was timed and compared with the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate<'a> {
    /// The run.
    pub run: &'a Run,
    /// Median [work](super::record::Time::work) of a frame, ms.
    pub ms: f64,
    /// RMSE against the truth, linear light.
    pub rmse: f64,
}

/// A scene at one size and shading, with its Pareto front.
#[derive(Clone, Debug, PartialEq)]
pub struct Column<'a> {
    /// What the runs show.
    pub view: View<'a>,
    /// The [`front`] of its runs.
    pub front: Vec<Candidate<'a>>,
    /// All of its runs.
    pub all: Vec<Candidate<'a>>,
}

/// Recommendations of one session; times of other sessions are of other machines.
#[derive(Clone, Debug, PartialEq)]
pub struct Recommendations<'a> {
    /// One per scene, size and shading, in the order of the runs.
    pub columns: Vec<Column<'a>>,
    /// [`budgets`] of time, ms.
    pub times: Vec<f64>,
    /// [`budgets`] of error.
    pub errors: Vec<f64>,
}

impl<'a> Recommendations<'a> {
    /// From the budget experiment's runs against exact pictures, without the CPU baseline and methods [as published](Method::PAPERS); none if
    /// there are no such runs.
    pub fn of(session: &'a Session) -> Option<Self> {
        let methods = |run: &&Run| {
            let method = Method::named(&run.implementation.method);
            let published = method.is_some_and(|method| method.is_as_published());
            let own = !run.implementation.is_baseline() && !published;
            run.experiment == Experiment::Budget && own && run.has_truth()
        };
        let groups = grouped(session.runs.iter().filter(methods), Run::view);
        let column = |(view, runs): (_, Vec<&'a Run>)| {
            let all = candidates(runs);
            Column { view, front: front(&all), all }
        };
        let mut columns: Vec<Column<'a>> = groups.into_iter().map(column).collect();
        columns.retain(|column| !column.front.is_empty());
        let best = || columns.iter().flat_map(|column| &column.front);
        let (times, errors) = (budgets(best().map(|o| o.ms)), budgets(best().map(|o| o.rmse)));
        (!columns.is_empty()).then_some(Self { columns, times, errors })
    }
}

impl<'a> Candidate<'a> {
    /// Whether the 95 % intervals of both median times overlap: which one is faster is unknown.
    pub fn is_as_fast_as(&self, other: &Self) -> bool {
        let interval = |run: &Run| run.time.as_ref().and_then(|time| time.work().interval);
        match (interval(self.run), interval(other.run)) {
            (Some([low, high]), Some([other_low, other_high])) => low <= other_high && other_low <= high,
            _ => false,
        }
    }
}

impl<'a> Column<'a> {
    /// Runs by other methods with an RMSE of at most `rmse` that may be as fast as `best`, the fastest one of each.
    pub fn as_fast(&self, best: &Candidate<'a>, rmse: f64) -> Vec<Candidate<'a>> {
        let mut others: Vec<Candidate<'a>> = self.all.clone();
        others.retain(|other| other.rmse <= rmse && other.is_as_fast_as(best));
        others.sort_by(|a, b| a.ms.total_cmp(&b.ms));
        let mut known = vec![&best.run.implementation];
        others.retain(|other| {
            let is_new = !known.contains(&&other.run.implementation);
            known.push(&other.run.implementation);
            is_new
        });
        others
    }
}

impl Candidate<'_> {
    /// Whether it takes less time, by the same clock.
    pub fn is_faster_than(&self, other: &Self) -> bool {
        let clock = |candidate: &Self| candidate.run.time.as_ref().map(|time| time.clock);
        self.ms < other.ms && clock(self) == clock(other)
    }
}

/// The runs that have a time and an error, both above 0.
pub fn candidates<'a>(runs: impl IntoIterator<Item = &'a Run>) -> Vec<Candidate<'a>> {
    let candidate = |run: &'a Run| match (run.refused.is_none(), run.ms(), run.rmse()) {
        (true, Some(ms), Some(rmse)) if rmse > 0.0 => Some(Candidate { run, ms, rmse }),
        _ => None,
    };
    runs.into_iter().filter_map(candidate).collect()
}

/// The Pareto front: ascending in time, descending in error; the first of equal runs.
pub fn front<'a>(candidates: &[Candidate<'a>]) -> Vec<Candidate<'a>> {
    let mut sorted = candidates.to_vec();
    sorted.sort_by(|a, b| a.ms.total_cmp(&b.ms).then(a.rmse.total_cmp(&b.rmse)));
    let mut least = f64::INFINITY;
    sorted.retain(|candidate| {
        let better = candidate.rmse < least;
        least = least.min(candidate.rmse);
        better
    });
    sorted
}

/// The run of least error within `ms`; none if all take longer.
pub fn within_time<'f, 'a>(front: &'f [Candidate<'a>], ms: f64) -> Option<&'f Candidate<'a>> {
    front.iter().rev().find(|candidate| candidate.ms <= ms)
}

/// The fastest run with an RMSE of at most `rmse`; none if all have more.
pub fn within_error<'f, 'a>(front: &'f [Candidate<'a>], rmse: f64) -> Option<&'f Candidate<'a>> {
    front.iter().find(|candidate| candidate.rmse <= rmse)
}

/// Round budgets from the first one that some value meets to the first one that all meet: 1, 2 and 5 times powers of
/// ten, or a finer series if there would be few.
pub fn budgets(values: impl IntoIterator<Item = f64>) -> Vec<f64> {
    let valid = values.into_iter().filter(|value| value.is_finite() && *value > 0.0);
    let range = valid.fold(None, |range: Option<[f64; 2]>, value| {
        let [min, max] = range.unwrap_or([value; 2]);
        Some([min.min(value), max.max(value)])
    });
    let Some(range) = range else { return Vec::new() };
    let coarse = series(&["1", "2", "5"], range);
    if coarse.len() < FEW { series(&["1", "1.5", "2", "3", "5", "7"], range) } else { coarse }
}

/// Least number of budgets in the coarse series.
const FEW: usize = 4;

/// The numbers that start with these digits; see [`budgets`].
fn series(digits: &[&str], [min, max]: [f64; 2]) -> Vec<f64> {
    let powers = min.log10().floor() as i32..=max.log10().ceil() as i32;
    // Parsed from text, to get the nearest number.
    let round =
        |power: i32| digits.iter().map(move |digit| format!("{digit}e{power}").parse().unwrap_or(f64::NAN));
    let mut budgets: Vec<f64> = powers.flat_map(round).filter(|budget| *budget >= min).collect();
    let enough = budgets.iter().position(|budget| *budget >= max);
    budgets.truncate(enough.map_or(budgets.len(), |last| last + 1));
    budgets
}

#[cfg(test)]
mod tests {
    use super::budgets;

    #[test]
    fn budgets_are_round_and_cover_the_values() {
        assert_eq!(budgets([42.0, 900.0]), [50.0, 100.0, 200.0, 500.0, 1000.0]);
        assert_eq!(budgets([0.02]), [0.02]);
        assert_eq!(budgets([0.021, 0.09]), [0.03, 0.05, 0.07, 0.1]);
        assert_eq!(budgets([f64::NAN, 0.0, f64::INFINITY, -1.0]), [0.0; 0]);
    }
}
