//! Time limit of a session: in which order plans are measured, and which are left out.
//!
//! Without a limit, plans keep their order. With one, each experiment of each scene begins with what takes the least time, and they take turns,
//! with pictures by a few methods at a time, the default one first: the largest numbers of points and pixels are left out first, and every scene
//! has some runs. Exact pictures are traced by fewer rays, and fewer frames are timed.

use super::plan::{Measurements, Plan};
use super::record::Missing;
use super::stopwatch::Effort;
use super::suites::Suite;
use crate::settings::Choice;
use crate::verify::truth;
use std::time::{Duration, Instant};

/// Share of a suite's time that its timed frames may take: the rest is for loading, exact pictures and metrics.
const FRAMES: f64 = 0.3;

/// Plans that are [beside](Plan::is_beside) each other: their frames take turns.
pub type Group = Vec<Plan>;

/// End of a suite that is one of `left` to be measured until `end`: each has the same time.
pub fn end_of_suite(end: Option<Instant>, left: usize) -> Option<Instant> {
    let now = Instant::now();
    end.map(|end| now + end.saturating_duration_since(now) / left.max(1) as u32)
}

/// The number of timed frames of `plans` plans that are to be measured until `until`.
pub fn effort(effort: Effort, plans: usize, until: Option<Instant>) -> Effort {
    let Some(end) = until else { return effort };
    let each = end.saturating_duration_since(Instant::now()).mul_f64(FRAMES) / plans.max(1) as u32;
    Effort { budget: effort.budget.min(each), until, ..effort }
}

/// Precision of the exact pictures of a suite: with a limit no better than of [`Suite::Quick`].
pub fn truth(suite: Suite, until: Option<Instant>) -> truth::Options {
    if until.is_some() { Suite::Quick.truth() } else { suite.truth() }
}

/// The groups of `plans` in the order of their measurement.
pub fn groups(plans: Vec<Plan>, is_limited: bool) -> Vec<Group> {
    let groups: Vec<Group> = plans.chunk_by(Plan::is_beside).map(<[Plan]>::to_vec).collect();
    if !is_limited {
        return groups;
    }
    let mut series: Vec<Vec<Group>> = Vec::new();
    for group in groups.iter().flat_map(|group| cut(group)) {
        match series.iter_mut().find(|known| is_of_series(&known[0], &group)) {
            Some(known) => known.push(group),
            None => series.push(vec![group]),
        }
    }
    series.iter_mut().for_each(|groups| groups.sort_by_key(work));
    let turns = series.iter().map(Vec::len).max().unwrap_or_default();
    (0..turns).flat_map(|turn| series.iter().filter_map(move |groups| groups.get(turn).cloned())).collect()
}

/// Most plans of a group whose pictures are compared, if time is limited.
const FEW: usize = 5;

/// Cuts a group by shading, and into few plans; one of times alone remains whole, so that all its frames take turns.
fn cut(group: &[Plan]) -> Vec<Group> {
    if group.iter().all(|plan| plan.measurements == Measurements::TIME) {
        return vec![group.to_vec()];
    }
    let shadings = group.chunk_by(|a, b| a.settings.shading == b.settings.shading);
    shadings.flat_map(|plans| plans.chunks(FEW)).map(<[Plan]>::to_vec).collect()
}

/// Whether both are of the same experiment and scene.
fn is_of_series(a: &Group, b: &Group) -> bool {
    let key = |group: &Group| (group[0].experiment, group[0].paper_item.clone(), group[0].scene.clone());
    key(a) == key(b)
}

/// Points, pixels and overlap of a plan's frame, about.
fn work(group: &Group) -> u64 {
    let Plan { points, size, radius_scale, .. } = &group[0];
    let covered = 1.0 + f64::from(radius_scale * radius_scale);
    ((*points as f64 + f64::from(size[0]) * f64::from(size[1])) * covered) as u64
}

/// Durations of earlier groups, by which those of later ones are estimated.
#[derive(Default)]
pub struct Estimates(Vec<(Group, Duration)>);

impl Estimates {
    /// Whether a group will probably be measured before `until`, by the last group of its experiment and scene, or else by the last one. The
    /// first group is begun while there is time.
    pub fn fit(&self, group: &Group, until: Option<Instant>) -> bool {
        let Some(until) = until else { return true };
        let left = until.saturating_duration_since(Instant::now());
        let alike = self.0.iter().rev().find(|(known, _)| is_of_series(known, group));
        left > alike
            .or(self.0.last())
            .map_or(Duration::ZERO, |(known, took)| Self::scaled(known, *took, group))
    }

    /// Adds the duration of a group.
    pub fn add(&mut self, group: Group, took: Duration) {
        self.0.push((group, took));
    }

    /// The time of a frame is between constant and proportional to its work: takes the geometric mean of both.
    fn scaled(known: &Group, took: Duration, group: &Group) -> Duration {
        let ratio = work(group) as f64 / work(known).max(1) as f64;
        took.mul_f64(group.len() as f64 / known.len() as f64 * ratio.max(1.0).sqrt())
    }
}

/// Plans of a group that were not measured; none if all were.
pub fn missing(plans: &[Plan]) -> Option<Missing> {
    let plan = plans.first()?;
    Some(Missing {
        suite: plan.suite.into(),
        experiment: plan.experiment.name().into(),
        paper_item: plan.paper_item.clone(),
        scene: plan.scene.clone(),
        points: plan.points,
        size: plan.size,
        count: plans.len(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::record::Experiment;
    use crate::bench::suites::UserInputs;
    use std::collections::HashSet;

    #[test]
    fn a_limit_leaves_out_the_largest() {
        let plans = Suite::Scaling.plans(&UserInputs::default());
        let count = plans.len();
        let unlimited: Vec<Plan> = groups(plans.clone(), false).concat();
        assert_eq!(unlimited, plans);
        let limited = groups(plans, true);
        assert_eq!(limited.concat().len(), count);
        let first: Vec<_> = limited[..4].iter().map(|group| group[0].experiment.name()).collect();
        assert_eq!(first, ["scaling-points", "filled", "scaling-size", "scaling-overlap"]);
        assert_eq!((limited[0][0].points, limited[2][0].size), (10_000, [256, 256]));
        // The last turn has the most points and the most overlap.
        let last: Vec<_> = limited[limited.len() - 2..].iter().map(|group| group[0].clone()).collect();
        assert!(last.iter().any(|plan| plan.points == 10_000_000), "{last:?}");
        assert!(last.iter().any(|plan| plan.experiment.name() == "scaling-overlap"), "{last:?}");
    }

    #[test]
    fn a_limit_begins_with_some_runs_of_every_scene() {
        let plans = Suite::Full.plans(&UserInputs::default());
        let scenes: HashSet<_> = plans.iter().map(|plan| plan.scene.clone()).collect();
        let limited = groups(plans.clone(), true);
        let budget = |group: &&Group| group[0].experiment == Experiment::Budget;
        let first: Vec<_> = limited.iter().take_while(budget).collect();
        let of_first: HashSet<_> = first.iter().map(|group| group[0].scene.clone()).collect();
        assert_eq!(
            (first.len(), of_first.len()),
            (scenes.len() - 1, scenes.len() - 1),
            "one of aliasing alone"
        );
        for group in first {
            assert!(
                group.len() <= FEW && group[0].implementation().label() == "perspective-ewa",
                "{}",
                group.len()
            );
        }
        // None is lost, and times alone are of whole groups.
        assert_eq!(limited.concat().len(), plans.len());
        let scaling = groups(Suite::Scaling.plans(&UserInputs::default()), true);
        assert!(scaling.iter().any(|group| group.len() > FEW));
    }

    #[test]
    fn what_probably_takes_longer_is_not_begun() {
        let groups = groups(Suite::Scaling.plans(&UserInputs::default()), true);
        let of = |points| groups.iter().find(|group| group[0].points == points).unwrap().clone();
        let mut estimates = Estimates::default();
        let in_seconds = |seconds| Some(Instant::now() + Duration::from_secs(seconds));
        assert!(estimates.fit(&of(10_000), in_seconds(1)) && !estimates.fit(&of(10_000), in_seconds(0)));
        estimates.add(of(10_000), Duration::from_secs(10));
        // Three of its ten plans, of about three times the work.
        assert!(
            !estimates.fit(&of(3_000_000), in_seconds(3)) && estimates.fit(&of(3_000_000), in_seconds(30))
        );
        assert!(estimates.fit(&of(3_000_000), None));
        // Of another experiment, with about as many pixels.
        let filled = of(4_000_000);
        assert!(!estimates.fit(&filled, in_seconds(2)) && estimates.fit(&filled, in_seconds(60)));
    }

    #[test]
    fn the_time_is_shared_by_suites_and_plans() {
        let end = Instant::now() + Duration::from_secs(100);
        let left = end_of_suite(Some(end), 4).unwrap().saturating_duration_since(Instant::now());
        assert!((20.0..=25.0).contains(&left.as_secs_f64()), "{left:?}");
        assert_eq!(end_of_suite(None, 4), None);
        let limited = effort(Effort::default(), 100, Some(end));
        assert!(limited.budget <= Duration::from_millis(300) && limited.until == Some(end));
        assert_eq!(effort(Effort::default(), 100, None), Effort::default());
    }
}
