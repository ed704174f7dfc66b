//! Summary: the best setting for each budget of time and of error.

use super::page::{Page, title};
use crate::bench::disturbance::disturbances;
use crate::bench::format;
use crate::bench::group::{distinct, grouped};
use crate::bench::recommendations::{Candidate, Column, Recommendations, within_error, within_time};
use crate::bench::record::{RunSettings, Session, TRACED};
use crate::bench::standings::{Standing, standings};
use crate::settings::methods::Method;
use maud::{Markup, html};
use std::io;

/// The default's standings, and two tables: rows are budgets, columns are scenes.
pub fn content(_: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let Some(recommendations) = Recommendations::of(session) else { return Ok(unranked(session)) };
    let standings = standings(session);
    let Recommendations { columns, times, errors } = &recommendations;
    let time = |budget: f64| format!("{} ms", format::ms(budget));
    let error = |budget: f64| format::significant(budget, 2);
    Ok(Some(html! {
        (default_table(&standings, &format::time_heading(&session.runs)))
        p.lead {
            "The best of the methods' runs on the Pareto front: no other run is both faster and more exact. "
            @if multiples(session) { "× is the time relative to the CPU baseline, a plain native renderer. " }
            "Settings are listed where they differ from the method's defaults; those of the default method are "
            code { (format::selected_settings(&RunSettings::defaults(), NAMED)) } "."
            (disturbed(session)) (few_frames(session))
        }
        (truth(session))
        h3 { "Least error within a time budget" }
        (table(session, &format::time_heading(&session.runs), columns, times, time, |column, ms| {
            within_time(&column.front, ms).map(|best| (best, Vec::new()))
        }, true))
        h3 { "Least time within an error budget" }
        p { "Either: methods whose 95 % intervals of the median time overlap with that of the fastest." }
        (table(session, "RMSE", columns, errors, error, |column, rmse| {
            within_error(&column.front, rmse).map(|best| (best, column.as_fast(best, rmse)))
        }, false))
    }))
}

/// Runs whose errors cannot be compared: no method is recommended.
fn unranked(session: &Session) -> Option<Markup> {
    let any = session.runs.iter().any(|run| run.rmse().is_some() && !run.has_truth());
    any.then(|| html! {
        p.lead {
            "No method is recommended: the surfaces of these points are unknown, so that errors of different methods cannot be compared. Give "
            "the mesh that the points were sampled from by " code { "--truth" } "."
            (disturbed(session)) (few_frames(session))
        }
    })
}

/// What `surfel render` draws without options, among all methods.
fn default_table(standings: &[Standing<'_>], time: &str) -> Markup {
    html! { @if !standings.is_empty() {
        h3 { "Without options" }
        p {
            code { (Method::SPLATTING[0].name) } " is what " code { "surfel render" } " draws without options. Each method as its preset, by "
            "RMSE, at the greatest number of points that most methods rendered."
        }
        (worst(standings))
        div.scroll { table.standings {
            thead { tr {
                th scope="col" { "scene" } th scope="col" { "place" } th.number scope="col" { "RMSE" } th.number scope="col" { (time) }
                th scope="col" { "least RMSE" } th.number scope="col" { "points" }
            } }
            tbody { @for standing in standings { (standing_row(standing)) } }
        } }
    } }
}

/// How often the default has the largest error, by shading.
fn worst(standings: &[Standing<'_>]) -> Markup {
    let of = |(shading, standings): (&str, Vec<&Standing<'_>>)| {
        let worst = standings.iter().filter(|standing| standing.is_worst).count();
        format!("{shading} in {worst} of {}", standings.len())
    };
    let counts: Vec<_> = grouped(standings, |standing| standing.view.shading).into_iter().map(of).collect();
    html! { @if standings.iter().any(|standing| standing.is_worst) {
        p { strong.bad { "It has the largest error of all methods: " (counts.join(", ")) "." } }
    } }
}

fn standing_row(standing: &Standing<'_>) -> Markup {
    let Standing { view, points, default, place, methods, best, is_worst, baselines } = standing;
    html! {
        tr.worst[*is_worst] {
            th scope="row" { (title(view)) }
            td { strong { (place) " of " (methods) } @if *is_worst { ", the worst" } }
            td.number { (format::error(default.rmse)) }
            td.number { (format::ms(default.ms)) }
            td {
                (format::error(best.rmse)) " by " (best.run.implementation.label()) " in " (format::ms(best.ms)) " ms"
                @for (baseline, is_fast) in baselines {
                    div {
                        strong { (baseline.run.implementation.label())
                            @if *is_fast { " is faster and more exact than every method" } @else { " is more exact than every method" }
                        }
                        ": RMSE " (format::error(baseline.rmse)) " in " (format::ms(baseline.ms)) " ms"
                    }
                }
            }
            td.number { (format::count(*points)) }
        }
    }
}

/// Low-pass filter, cut-off, widening, ε, culling and α; the shading is the same for all runs of a scene.
const NAMED: [bool; 10] = [true, true, true, true, true, true, true, false, false, false];

fn table<'c, 'a>(
    session: &Session,
    unit: &str,
    columns: &'c [Column<'a>],
    budgets: &[f64],
    name: impl Fn(f64) -> String,
    best: impl Fn(&'c Column<'a>, f64) -> Option<(&'c Candidate<'a>, Vec<Candidate<'a>>)>,
    error_first: bool,
) -> Markup {
    let mut before: Vec<Option<(&Candidate, Vec<Candidate>)>> = vec![None; columns.len()];
    html! {
        div.scroll { table.summary {
            thead { tr {
                th scope="col" { "budget, " (unit) }
                @for column in columns { th scope="col" { (title(&column.view)) } }
            } }
            tbody { @for budget in budgets { tr {
                th scope="row" { "≤ " (name(*budget)) }
                @for (column, before) in columns.iter().zip(&mut before) {
                    @let found = best(column, *budget);
                    @let same = found.is_some() && std::mem::replace(before, found.clone()) == found;
                    @match found {
                        Some((candidate, others)) => { td.same[same] { (cell(session, candidate, &others, error_first)) } }
                        None => { td.none { "none" } }
                    }
                }
            } } }
        } }
    }
}

fn cell(session: &Session, candidate: &Candidate<'_>, others: &[Candidate<'_>], error_first: bool) -> Markup {
    let Candidate { run, ms, rmse } = candidate;
    let multiple = run.time.as_ref().and_then(|time| time.baseline_ratio).map(format::baseline_ratio);
    let time =
        format!("{} ms", format::ms(*ms)) + &multiple.map(|text| format!(" ({text})")).unwrap_or_default();
    let error = format!("RMSE {}", format::error(*rmse));
    let [first, second] = if error_first { [error, time] } else { [time, error] };
    html! {
        strong { (first) } span { (second) }
        span { (format::count(run.points)) " points, " (run.implementation.label()) }
        @let settings = format::options(run);
        @if !settings.is_empty() { span { (settings) } }
        @let disturbances = format::disturbances(session, run);
        @if !disturbances.is_empty() { span.disturbed { (disturbances) } }
        @for Candidate { run, ms, .. } in others {
            span { "either: " (format::count(run.points)) " points, " (run.implementation.label()) ", " (format::ms(*ms)) " ms" }
        }
    }
}

/// How many of the session's times may not be those of the work.
fn disturbed(session: &Session) -> Markup {
    let timed = session.runs.iter().filter(|run| run.time.is_some()).count();
    let disturbed = session.runs.iter().filter(|run| !disturbances(session, run).is_empty()).count();
    html! { @if disturbed > 0 {
        " " strong.disturbed { "The times of " (disturbed) " of " (timed) " runs were disturbed" }
        " and are marked: measure again on a quiet machine. Busy machine: logical processors that other programs used. Waited: the wall time of "
        "a frame, and the one that its work takes in like runs."
    } }
}

/// The filter of the truth, by which methods are ranked.
fn truth(session: &Session) -> Markup {
    let errors = session.runs.iter().filter(|run| run.has_truth()).filter_map(|run| run.error.as_ref());
    let filters = distinct(errors.map(|error| error.filter.as_str()));
    html! { @for filter in filters { p {
        "Errors are against exact pictures filtered by " strong { (format::truth_filter(filter)) } ". A method that filters otherwise, or not at all, has "
        "an error by that alone: "
        @if filter == "gaussian" {
            "methods as published, whose outlines are not filtered, and what has no filter have more of it than presets that filter by nearly the same Gaussian. "
            code { "--filter box" } " measures against the mean over each pixel."
        } @else { "presets that filter by a Gaussian have more of it than with " code { "--filter gaussian" } "." }
    } } }
}

/// How many of the session's times have no interval; ray tracing is timed once anyway.
fn few_frames(session: &Session) -> Markup {
    let timed = session.runs.iter().filter(|run| run.implementation.method != TRACED);
    let timed: Vec<_> = timed.filter_map(|run| run.time.as_ref()).collect();
    let few = timed.iter().filter(|time| !time.has_interval()).count();
    html! { @if few > 0 {
        " The times of " (few) " of " (timed.len()) " runs are of fewer than six frames, which give no 95 % interval."
    } }
}

/// Whether there are times relative to the CPU baseline.
fn multiples(session: &Session) -> bool {
    session.runs.iter().any(|run| run.time.as_ref().is_some_and(|time| time.baseline_ratio.is_some()))
}
