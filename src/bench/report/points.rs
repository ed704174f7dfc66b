//! Error against the number of points: where it stops falling, and the residual error.

use super::page::{Page, grouped, titled};
use super::plot::{Line, Plot, Scale, Style};
use crate::bench::falling::{Fall, SHARE, SLOPE, Step, fall, left, steps};
use crate::bench::record::{Error, Experiment, Implementation, Run, RunSettings, Session};
use crate::bench::show;
use maud::{Markup, html};
use std::io;

/// Values below this share of the largest error lie on the plot's lower edge.
const SHOWN: f64 = 1e-3;

/// A plot per scene, of the settings that were measured with the most numbers of points, and its evaluation.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let compared = |run: &&Run| run.experiment == Experiment::Budget && run.rmse().is_some();
    let runs = session.runs.iter().filter(compared);
    let mut plots = Vec::new();
    for ((scene, size), runs) in grouped(runs, |run| (&run.scene, run.size)) {
        if let Some((implementation, setting, runs)) = main(&runs) {
            let axes = [("points", Scale::Log), ("RMSE and its terms, linear light", Scale::Log)];
            let name = format!("error-points-{}-{}", show::scene(scene), show::size(size));
            let largest = runs.iter().filter_map(|run| run.rmse()).fold(0.0, f64::max);
            let plot = Plot::of(name, titled(scene, size), axes, lines(&runs)).above(SHOWN * largest);
            let plot = page.plot(plot)?;
            let how = show::told(setting, [true, true, true, true, false, false, false]);
            plots.push(html! { div {
                (plot)
                p.caption { (implementation.label()) ", " (how) ". " (sentence(&runs)) }
            } });
        }
    }
    Ok((!plots.is_empty()).then(|| html! {
        p {
            "silhouette² + inside² = RMSE². The others are how far the picture would move without their cause, and overlap with these "
            "two: " a href="#terms" { "definitions" } ". The error counts as falling between two numbers of points if the slope of "
            "log RMSE over log points is below " (show::significant(SLOPE, 2)) ", that is by a fifth or more with ten times the points. What is "
            "left is put down to a cause that alone makes up " (show::significant(100.0 * SHARE, 2)) " % or more of the RMSE, otherwise to the "
            "larger of silhouette and inside, which is texture, or shade where there is no texture."
        }
        div.plots { @for plot in &plots { (plot) } }
    }))
}

/// The implementation and settings with the most numbers of points; of several those nearest to the defaults, then the
/// first.
fn main<'r>(runs: &[&'r Run]) -> Option<(&'r Implementation, &'r RunSettings, Vec<&'r Run>)> {
    let shipped = show::settings(&RunSettings::defaults());
    let rank = |setting: &RunSettings, runs: &[&Run]| {
        let unlike = show::settings(setting).iter().zip(&shipped).filter(|(a, b)| a != b).count();
        let terms =
            runs.iter().filter(|run| run.error.as_ref().is_some_and(|e| e.terms.hidden.is_some())).count();
        (std::cmp::Reverse((terms, steps(runs.iter().copied()).len())), unlike)
    };
    let groups = grouped(runs.iter().copied(), |run| (&run.implementation, &run.settings));
    let best = groups.into_iter().min_by_key(|((_, setting), runs)| rank(setting, runs));
    best.map(|((implementation, setting), mut runs)| {
        runs.sort_by_key(|run| run.points);
        (implementation, setting, runs)
    })
}

/// Name, style and value of a term.
type Term = (&'static str, Style, fn(&Error) -> Option<f64>);

fn lines(runs: &[&Run]) -> Vec<Line> {
    let terms: [Term; 6] = [
        ("RMSE", Style::nth(6), |error| error.metrics.get("rmse").copied()),
        ("silhouette", Style { marker: 1, ..Style::nth(0) }, |error| Some(error.terms.silhouette)),
        ("inside", Style { marker: 2, ..Style::nth(1) }, |error| Some(error.terms.inside)),
        ("hidden surfels (ε)", Style { marker: 4, ..Style::nth(2) }, |error| error.terms.hidden),
        ("precision", Style::nth(3), |error| error.terms.precision),
        ("truth's own error", Style { dashed: true, hollow: true, ..Style::nth(5) }, |error| {
            Some(error.truth_rms)
        }),
    ];
    let mut lines = Vec::new();
    for (label, style, of) in terms {
        let point = |run: &&Run| Some([run.points as f64, of(run.error.as_ref()?)?]);
        let points: Vec<_> = runs.iter().filter_map(point).collect();
        if !points.is_empty() {
            lines.push(Line::new(label, style, points));
        }
    }
    lines
}

/// Where the error falls, where it stops falling, and the residual error.
fn sentence(runs: &[&Run]) -> String {
    let told = |step: Step| format!("{} ({})", show::count(step.points), show::significant(step.rmse, 2));
    let (falls, end) = match fall(&steps(runs.iter().copied())) {
        Fall::Unknown => return "One number of points alone tells no slope.".into(),
        Fall::Nowhere => ("The error does not fall with the points".into(), None),
        Fall::Until([from, to]) => (
            format!("The error falls from {} to {} points and stops falling there", told(from), told(to)),
            Some(to),
        ),
        Fall::Throughout([from, to]) => (
            format!("The error falls from {} to {} points, the most measured", told(from), told(to)),
            Some(to),
        ),
    };
    let run = end.and_then(|end| runs.iter().find(|run| run.points == end.points)).or(runs.last());
    match run.and_then(|run| left(run)) {
        Some(left) => {
            let size = show::significant(left.size, 2);
            format!(
                "{falls}; what is left is mostly {}, {size}. {}",
                left.term,
                run.map(causes).unwrap_or_default()
            )
        }
        None => falls + ".",
    }
}

/// All causes that were measured.
fn causes(run: &&Run) -> String {
    let Some(error) = &run.error else { return String::new() };
    let causes = [
        ("hidden surfels", error.terms.hidden),
        ("precision", error.terms.precision),
        ("the truth", Some(error.truth_rms)),
    ];
    let told = |(name, size): (&str, Option<f64>)| Some(format!("{name} {}", show::significant(size?, 2)));
    let list = causes.into_iter().filter_map(told).collect::<Vec<_>>().join(", ");
    format!("Causes at {} points: {list}.", show::count(run.points))
}
