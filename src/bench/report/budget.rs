//! Time against error.

use super::page::{Page, title};
use super::plot::{Kind, Line, Plot, Scale, Style};
use crate::bench::disturbance::disturbances;
use crate::bench::format;
use crate::bench::group::{distinct, grouped};
use crate::bench::recommendations::{Candidate, candidates, front};
use crate::bench::record::{BOX_FILTER, Experiment, Run, Session, TRACED};
use maud::{Markup, html};
use std::io;

/// A plot per scene, size and shading: a line per implementation over its numbers of points, and the Pareto front of all where the surface is
/// known.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let exact = plots(page, session, true)?;
    let own = plots(page, session, false)?;
    let any = !exact.is_empty() || !own.is_empty();
    let mut traced =
        session.runs.iter().filter(|run| run.implementation.method == TRACED && run.rmse().is_some());
    let is_boxed = traced.clone().any(|run| run.implementation.variant == BOX_FILTER);
    let is_traced = traced.next().is_some();
    Ok(any.then(|| html! {
        p {
            @if !exact.is_empty() { "Lower left is better. " }
            "A line joins the runs of a method over the number of points, with the settings of least error for "
            "each number. Pale markers are its other settings. Rings mark what "
            code { "surfel render" } " draws without options, but for the shading. Dashed lines are the CPU baseline, which is no method. Bars are 95 % intervals of the median "
            "time, which fewer than six frames do not give; crosses are times that were disturbed. "
            @if is_traced { code { (TRACED) } " below the plots is what tracing 16 rays a pixel gives: of the exact surface of a built-in scene, or of the "
            "triangles between the same points of a scan, with the truth's filter. " }
            @if is_boxed { code { (TRACED) " " (BOX_FILTER) } " is the mean of 16 rays over the pixel's square: what a triangle renderer with 16 "
            "samples a pixel shows of the same points." }
        }
        @if !exact.is_empty() {
            p {
                "The grey band is the Pareto front of all methods, labelled with numbers of points. Hollow markers are other settings on it."
            }
            div.plots { @for plot in &exact { (plot) } }
        }
        @if !own.is_empty() {
            h3 { "Aliasing and thinning only, not truth" }
            p {
                "The surface of these points is unknown. Each method is compared with its own float64 reference of all points at 64 rays a "
                "pixel: what it would show without aliasing and without leaving out points. A method that is wrong everywhere has no error "
                "here, so that the errors of different methods say nothing about each other. Compare a line with itself."
            }
            div.plots { @for plot in &own { (plot) } }
        }
    }))
}

/// The plots of runs against exact pictures, or against the methods' own references.
fn plots(page: &mut Page<'_>, session: &Session, exact: bool) -> io::Result<Vec<Markup>> {
    let compared = |run: &&Run| run.experiment == Experiment::Budget && run.has_truth() == exact;
    let mut plots = Vec::new();
    for (view, runs) in grouped(session.runs.iter().filter(compared), Run::view) {
        let candidates = candidates(runs);
        if !candidates.is_empty() {
            let runs = candidates.iter().map(|candidate| candidate.run);
            let time = format::time_heading(runs.clone());
            let error = match exact {
                true => format::error_heading("RMSE", runs),
                false => "RMSE against the method's own reference".into(),
            };
            let axes = [(time.as_str(), Scale::Log), (error.as_str(), Scale::Log)];
            let name = format!("time-error-{}", title(&view));
            let (traced, drawn): (Vec<_>, Vec<_>) =
                candidates.into_iter().partition(|candidate| candidate.run.implementation.method == TRACED);
            let plot = page.plot(Plot::of(name, title(&view), axes, lines(page, session, &drawn, exact)))?;
            plots.push(html! { div { (plot) (far_below(&traced, &drawn)) } });
        }
    }
    Ok(plots)
}

/// Ray tracing, in words: on the plot it would take the methods' room. Beside it the error of the picture without options, in its units.
fn far_below(traced: &[Candidate<'_>], drawn: &[Candidate<'_>]) -> Markup {
    let default = |points: u64| drawn.iter().find(|o| o.run.points == points && o.run.is_default());
    let one = |candidate: &&Candidate<'_>| {
        let points = candidate.run.points;
        let (rmse, ms) = (format::error(candidate.rmse), format::ms(candidate.ms));
        let without_options = default(points).map_or(String::new(), |default| {
            format!("; without options {:.2} times as much", default.rmse / candidate.rmse)
        });
        format!("{}: RMSE {rmse} in {ms} ms of CPU time{without_options}", format::count(points))
    };
    let captions = grouped(traced, |candidate| candidate.run.implementation.label()).into_iter();
    let captions = captions.map(|(label, runs)| (label, runs.iter().map(one).collect::<Vec<_>>().join("; ")));
    html! { @for (label, all) in captions { p.caption { code { (label) } ", by points: " (all) "." } } }
}

fn lines(page: &Page<'_>, session: &Session, candidates: &[Candidate<'_>], exact: bool) -> Vec<Line> {
    let methods: Vec<Candidate> =
        candidates.iter().filter(|o| exact && !o.run.implementation.is_baseline()).copied().collect();
    let best = front(&methods);
    let mut lines = Vec::new();
    if exact {
        let band = Style { kind: Kind::Band, ..Style::default() };
        lines.push(Line { notes: counts(&best), ..Line::new("Pareto front", band, places(&best)) });
    }
    let disturbed = candidates.iter().filter(|candidate| !disturbances(session, candidate.run).is_empty());
    let disturbed: Vec<_> = disturbed.copied().collect();
    let crosses = Style { kind: Kind::Crosses, ..Style::default() };
    lines.extend((!disturbed.is_empty()).then(|| Line::new("disturbed", crosses, places(&disturbed))));
    let default: Vec<_> = candidates.iter().filter(|candidate| candidate.run.is_default()).copied().collect();
    let ring = Style { kind: Kind::Ring, ..Style::default() };
    lines.extend((!default.is_empty()).then(|| Line::new("without options", ring, places(&default))));
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
        lines.push(Line::new("", Style { kind: Kind::Whiskers, ..style }, intervals(&joined)));
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

/// Ends of the 95 % intervals of the times.
fn intervals(candidates: &[Candidate<'_>]) -> Vec<[f64; 2]> {
    let ends = |candidate: &Candidate<'_>| {
        let interval = candidate.run.time.as_ref()?.work().interval?;
        Some(interval.map(|ms| [ms, candidate.rmse]))
    };
    candidates.iter().filter_map(ends).flatten().collect()
}

/// For each number of points the run of least error, in ascending order.
fn least_errors<'a>(candidates: &[Candidate<'a>]) -> Vec<Candidate<'a>> {
    let mut sorted = candidates.to_vec();
    sorted.sort_by(|a, b| a.run.points.cmp(&b.run.points).then(a.rmse.total_cmp(&b.rmse)));
    sorted.dedup_by_key(|candidate| candidate.run.points);
    sorted
}
