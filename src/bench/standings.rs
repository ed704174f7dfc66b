//! Standings: the place of the default method among all methods, where the surface is known.

use super::group::{distinct, grouped};
use super::recommendations::{Candidate, candidates};
use super::record::{Experiment, Run, Session, View};

/// The methods at one number of points, each as its preset.
#[derive(Clone, Debug, PartialEq)]
pub struct Standing<'a> {
    /// What the runs show.
    pub view: View<'a>,
    /// Number of points: of those that the default method rendered, the one that most methods did, then the greatest.
    pub points: u64,
    /// The default method.
    pub default: Candidate<'a>,
    /// Its place by error, from 1; methods of equal error share one.
    pub place: usize,
    /// Number of methods.
    pub methods: usize,
    /// The method of least error.
    pub best: Candidate<'a>,
    /// Whether none has a greater error than the default method.
    pub is_worst: bool,
    /// Baselines that are more exact than every method, and whether they are faster than every method, too.
    pub baselines: Vec<(Candidate<'a>, bool)>,
}

/// A smaller difference of errors is none.
const LESS: f64 = 0.99;

/// Standings of every scene, size and shading, in the order of the runs.
pub fn standings(session: &Session) -> Vec<Standing<'_>> {
    let compared = |run: &&Run| run.experiment == Experiment::Budget && run.has_truth();
    let groups = grouped(session.runs.iter().filter(compared), Run::view);
    groups.into_iter().filter_map(|(view, runs)| standing(view, &runs)).collect()
}

fn standing<'a>(view: View<'a>, runs: &[&'a Run]) -> Option<Standing<'a>> {
    let densities = distinct(runs.iter().map(|run| run.points));
    let all = densities.into_iter().filter_map(|points| {
        let own = candidates(runs.iter().copied().filter(|run| run.points == points));
        let methods: Vec<_> = own.iter().filter(|candidate| candidate.run.is_preset()).copied().collect();
        let default = methods.iter().copied().find(|candidate| candidate.run.is_default())?;
        let best = methods.iter().copied().min_by(|a, b| a.rmse.total_cmp(&b.rmse))?;
        let better = methods.iter().filter(|candidate| candidate.rmse < default.rmse).count();
        let baselines = own.iter().filter(|candidate| candidate.run.implementation.is_baseline());
        let is_exact =
            |baseline: &&Candidate<'_>| methods.iter().all(|method| baseline.rmse < LESS * method.rmse);
        let is_fast = |baseline: &Candidate<'_>| methods.iter().all(|method| baseline.is_faster_than(method));
        (methods.len() > 1).then(|| Standing {
            view,
            points,
            default,
            place: better + 1,
            methods: methods.len(),
            best,
            is_worst: methods.iter().all(|candidate| candidate.rmse <= default.rmse),
            baselines: baselines.filter(is_exact).map(|baseline| (*baseline, is_fast(baseline))).collect(),
        })
    });
    all.max_by_key(|standing| (standing.methods, standing.points))
}
