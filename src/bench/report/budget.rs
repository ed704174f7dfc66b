//! Time against error.

use super::page::{Page, titled};
use super::plot::{Kind, Line, Plot, Scale, Style};
use crate::bench::format;
use crate::bench::group::{distinct, grouped};
use crate::bench::recommendations::{Candidate, candidates, front};
use crate::bench::record::{Experiment, Session};
use maud::{Markup, html};
use std::io;

/// A plot per scene: a line per implementation over its numbers of points, and the Pareto front of all.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let runs = session.runs.iter().filter(|run| run.experiment == Experiment::Budget);
    let mut plots = Vec::new();
    for ((scene, size), runs) in grouped(runs, |run| (&run.scene, run.size)) {
        let candidates = candidates(runs);
        if !candidates.is_empty() {
            let axes = [("time of a frame, ms", Scale::Log), ("RMSE, linear light", Scale::Log)];
            let name = format!("time-error-{}-{}", format::scene(scene), format::size(size));
            plots.push(page.plot(Plot::of(name, titled(scene, size), axes, lines(page, &candidates)))?);
        }
    }
    Ok((!plots.is_empty()).then(|| html! {
        p {
            "Lower left is better. A line joins the runs of a method over the number of points, with the settings of least error for "
            "each number. Other markers are its other settings: hollow on the Pareto front, pale elsewhere. The grey band is the Pareto "
            "front of all methods, labelled with numbers of points. Dashed lines are the CPU baseline, which is no method."
        }
        div.plots { @for plot in &plots { (plot) } }
    }))
}

fn lines(page: &Page<'_>, candidates: &[Candidate<'_>]) -> Vec<Line> {
    let methods: Vec<Candidate> =
        candidates.iter().filter(|o| !o.run.implementation.is_baseline()).copied().collect();
    let best = front(&methods);
    let band = Style { kind: Kind::Band, ..Style::default() };
    let mut lines = vec![Line { notes: counts(&best), ..Line::new("Pareto front", band, places(&best)) }];
    for implementation in distinct(candidates.iter().map(|candidate| &candidate.run.implementation)) {
        let own: Vec<Candidate> =
            candidates.iter().filter(|o| o.run.implementation == *implementation).copied().collect();
        let joined = least_errors(&own);
        let others = own.into_iter().filter(|candidate| !joined.contains(candidate));
        let (good, others): (Vec<Candidate>, Vec<Candidate>) =
            others.partition(|candidate| best.contains(candidate));
        let style = Style { dashed: implementation.is_baseline(), ..page.style(implementation) };
        let loose = Style { kind: Kind::Loose, hollow: true, ..style };
        for (style, candidates) in [(Style { kind: Kind::Faint, ..style }, &others), (loose, &good)] {
            lines.push(Line::new("", style, places(candidates)));
        }
        lines.push(Line::new(implementation.label(), style, places(&joined)));
    }
    lines
}

/// Numbers of points along the front; repetitions are empty.
fn counts(front: &[Candidate<'_>]) -> Vec<String> {
    let same = |i: usize| i > 0 && front[i - 1].run.points == front[i].run.points;
    (0..front.len())
        .map(|i| if same(i) { String::new() } else { format::count(front[i].run.points) })
        .collect()
}

fn places(candidates: &[Candidate<'_>]) -> Vec<[f64; 2]> {
    candidates.iter().map(|candidate| [candidate.ms, candidate.rmse]).collect()
}

/// For each number of points the run of least error, in ascending order.
fn least_errors<'a>(candidates: &[Candidate<'a>]) -> Vec<Candidate<'a>> {
    let mut sorted = candidates.to_vec();
    sorted.sort_by(|a, b| a.run.points.cmp(&b.run.points).then(a.rmse.total_cmp(&b.rmse)));
    sorted.dedup_by_key(|candidate| candidate.run.points);
    sorted
}
