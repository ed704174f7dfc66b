//! Error against the number of points: where it stops falling, and the residual error.

use super::page::{Page, title};
use super::plot::{Line, Plot, Scale, Style};
use crate::bench::convergence::{
    Convergence, ErrorAt, SHARE, SLOPE, convergence, errors_by_points, residual,
};
use crate::bench::format;
use crate::bench::group::grouped;
use crate::bench::record::{Error, Experiment, Implementation, Run, RunSettings, Session};
use maud::{Markup, html};
use std::io;

/// Values below this share of the largest error lie on the plot's lower edge.
const SHOWN: f64 = 1e-3;

/// A plot per scene, of the settings that were measured with the most numbers of points, and its evaluation.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let compared =
        |run: &&Run| run.experiment == Experiment::Budget && run.rmse().is_some() && run.has_truth();
    let runs = session.runs.iter().filter(compared);
    let mut plots = Vec::new();
    for (view, runs) in grouped(runs, Run::view) {
        if let Some((implementation, setting, runs)) = most_points(&runs) {
            let error = format::error_heading("RMSE and its terms", runs.iter().copied());
            let axes = [("points", Scale::Log), (error.as_str(), Scale::Log)];
            let name = format!("error-points-{}", title(&view));
            let largest = runs.iter().filter_map(|run| run.rmse()).fold(0.0, f64::max);
            let plot = Plot::of(name, title(&view), axes, lines(&runs)).above(SHOWN * largest);
            let plot = page.plot(plot)?;
            let how = format::selected_settings(setting, std::array::from_fn(|i| i < 4));
            plots.push(html! { div {
                (plot)
                p.caption { code { (format::with_options(implementation, &how)) } ". " (sentence(&runs)) }
            } });
        }
    }
    Ok((!plots.is_empty()).then(|| html! {
        p {
            "silhouette² + inside² = RMSE². The other terms are the change of the picture without their cause, and overlap with these "
            "two: " a href="#glossary" { "definitions" } ". The error counts as falling between two numbers of points if the slope of "
            "log RMSE over log points is below " (format::significant(SLOPE, 2)) ", a decrease by a fifth or more with ten times the points. The residual "
            "error is attributed to a cause that makes up " (format::significant(100.0 * SHARE, 2)) " % or more of the RMSE, otherwise to the "
            "larger of silhouette and inside; the latter is texture, or shading where there is no texture."
        }
        div.plots { @for plot in &plots { (plot) } }
    }))
}

/// The implementation and settings with the most numbers of points; of several those nearest to the defaults, then the
/// first.
fn most_points<'r>(runs: &[&'r Run]) -> Option<(&'r Implementation, &'r RunSettings, Vec<&'r Run>)> {
    let defaults = format::settings(&RunSettings::defaults());
    let rank = |setting: &RunSettings, runs: &[&Run]| {
        let changed = format::settings(setting).iter().zip(&defaults).filter(|(a, b)| a != b).count();
        let terms =
            runs.iter().filter(|run| run.error.as_ref().is_some_and(|e| e.terms.hidden.is_some())).count();
        (std::cmp::Reverse((terms, errors_by_points(runs.iter().copied()).len())), changed)
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
    let at =
        |step: ErrorAt| format!("{} ({})", format::count(step.points), format::significant(step.rmse, 2));
    let (falls, end) = match convergence(&errors_by_points(runs.iter().copied())) {
        Convergence::Unknown => return "One number of points gives no slope.".into(),
        Convergence::Nowhere => ("The error does not fall with the number of points".into(), None),
        Convergence::StopsAt([from, to]) => (
            format!("The error falls from {} to {} points and stops falling there", at(from), at(to)),
            Some(to),
        ),
        Convergence::Continues([from, to]) => {
            (format!("The error falls from {} to {} points, the most measured", at(from), at(to)), Some(to))
        }
    };
    let run = end.and_then(|end| runs.iter().find(|run| run.points == end.points)).or(runs.last());
    match run.and_then(|run| residual(run)) {
        Some(residual) => {
            let size = format::significant(residual.size, 2);
            format!(
                "{falls}; the residual error is mostly {}, {size}. {}",
                residual.term,
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
    let text = |(name, size): (&str, Option<f64>)| Some(format!("{name} {}", format::significant(size?, 2)));
    let list = causes.into_iter().filter_map(text).collect::<Vec<_>>().join(", ");
    format!("Causes at {} points: {list}.", format::count(run.points))
}
