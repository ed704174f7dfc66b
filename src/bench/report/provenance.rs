//! Provenance of the figures.

use super::page::Page;
use crate::bench::format;
use crate::bench::group::distinct;
use crate::bench::record::{Against, Provenance, Run, Session};
use crate::settings::Choice;
use maud::{Markup, html};
use std::collections::BTreeSet;
use std::io;

/// Command, machine and pass times.
pub fn content(_: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    Ok(Some(html! {
        (origin(session))
        (missing(session))
        (passes(session))
    }))
}

fn origin(session: &Session) -> Markup {
    let provenance: &Provenance = &session.provenance;
    let host = &provenance.host;
    html! {
        dl {
            dt { "command" } dd { code { (provenance.command) } }
            dt { "date" } dd { (provenance.date.strftime("%Y-%m-%d %H:%M UTC")) ", took " (format::significant(provenance.seconds, 3)) " s" }
            dt { "program" } dd { "surfel " (provenance.version) ", commit " code { (format::commit(&provenance.commit)) } }
            @if let Some(gpu) = &provenance.device {
                dt { "device" } dd { (gpu.name) }
                dt { "driver" } dd { (gpu.driver) @if gpu.validated { " (with validation layers, which take time)" } }
            } @else { dt { "device" } dd { "none" } }
            dt { "processor" } dd { (host.cpu) ", " (host.cores) " logical cores, " (format::mib(host.memory)) " MiB of memory" }
            dt { "system" } dd { (host.system) }
            dt { "frames" } dd { (frames(&session.runs)) }
            dt { "truth" } dd { (truth(&session.runs)) }
        }
    }
}

/// What the time did not suffice for.
fn missing(session: &Session) -> Markup {
    html! { @if !session.missing.is_empty() {
        details {
            summary { (format::missing(session).unwrap_or_default()) }
            div.scroll { table {
                thead { tr {
                    th scope="col" { "suite" } th scope="col" { "experiment" } th scope="col" { "scene" } th.number scope="col" { "points" }
                    th scope="col" { "size" } th.number scope="col" { "runs" }
                } }
                tbody { @for missing in &session.missing { tr {
                    td { (missing.suite) } td { (missing.experiment) " " (missing.paper_item) } td { (format::scene(&missing.scene)) }
                    td.number { @if missing.points > 0 { (format::count(missing.points)) } }
                    td { @if missing.points > 0 { (format::size(missing.size)) } } td.number { (missing.count) }
                } } }
            } }
        }
    } }
}

/// Numbers of timed and of warm-up frames over all runs.
fn frames(runs: &[Run]) -> String {
    let counts = |of: fn(&crate::bench::record::Time) -> usize| {
        let all: BTreeSet<usize> = runs.iter().filter_map(|run| run.time.as_ref()).map(of).collect();
        match (all.first(), all.last()) {
            (Some(least), Some(most)) if least < most => format!("{least} to {most}"),
            (Some(same), _) => same.to_string(),
            _ => "no".into(),
        }
    };
    format!(
        "{} per run after {} warm-up frames; methods with the same points take turns, frame by frame and equally often; times are of a frame \
         without read-back",
        counts(|time| time.frames),
        counts(|time| time.warmup)
    )
}

/// What runs are compared with: exact pictures, their own references, or both.
fn truth(runs: &[Run]) -> String {
    let of = |against| {
        runs.iter().filter_map(|run| run.error.as_ref()).filter(move |error| error.against == against)
    };
    let filters = |against| {
        let names: BTreeSet<&str> = of(against).map(|error| error.filter.as_str()).collect();
        let names = names.into_iter().map(format::truth_filter).collect::<Vec<_>>().join(" and ");
        Some(names).filter(|names| !names.is_empty())
    };
    let worst = of(Against::Surface).map(|error| error.truth_rms).fold(0.0, f64::max);
    let exact = filters(Against::Surface).map(|filters| {
        format!(
            "rays traced against the exact surface in float64, filtered by {filters}; its own standard error is at most {} (root mean square \
             over a picture)",
            format::significant(worst, 2)
        )
    });
    let own = filters(Against::OwnReference).map(|filters| {
        format!("where the surface is unknown, each method's own float64 reference at 64 rays a pixel, filtered by {filters}")
    });
    match exact.into_iter().chain(own).collect::<Vec<_>>() {
        none if none.is_empty() => "no run was compared with the truth".into(),
        all => all.join("; "),
    }
}

/// Median time of each pass, a row per run; only of runs with pass times.
fn passes(session: &Session) -> Markup {
    let timed: Vec<(&Run, _)> =
        session.runs.iter().filter_map(|run| Some((run, run.time.as_ref()?))).collect();
    let timed: Vec<_> = timed.into_iter().filter(|(_, time)| !time.passes.is_empty()).collect();
    let names = distinct(timed.iter().flat_map(|(_, time)| &time.passes).map(|pass| pass.name.as_str()));
    html! { @if !timed.is_empty() {
        details {
            summary { "Times of the passes: " (timed.len()) " runs" }
            p { "Median and range over the frames by the device's timestamps, ms, with the caller's wall time and the processor time of all threads; and why some times may not be those of the work." }
            div.scroll { table.passes {
                thead { tr {
                    th scope="col" { "experiment" } th scope="col" { "scene" } th.number scope="col" { "points" } th scope="col" { "size" }
                    th scope="col" { "implementation" } th scope="col" { "options" }
                    @for name in &names { th.number scope="col" { (name) } }
                    th.number scope="col" { "frames" } th.number scope="col" { "device" } th.number scope="col" { "wall" } th.number scope="col" { "CPU" }
                    th scope="col" { "disturbed" }
                } }
                tbody { @for (run, time) in &timed { tr {
                    td { (run.experiment.name()) } td { (format::scene(&run.scene)) }
                    td.number { (format::count(run.points)) } td { (format::size(run.size)) }
                    td { (run.implementation.label()) } td { (format::options(run)) }
                    @for name in &names {
                        @let pass = time.passes.iter().find(|pass| pass.name == *name);
                        td.number { @if let Some(pass) = pass { (spread(pass.ms)) } }
                    }
                    td.number { (time.frames) } td.number { @if let Some(device) = time.device { (spread(device)) } }
                    td.number { (spread(time.wall)) } td.number { (spread(time.cpu)) }
                    td { (format::disturbances(session, run)) }
                } } }
            } }
        }
    } }
}

fn spread(times: crate::frame::times::Statistics) -> Markup {
    html! { (format::ms(times.median)) small { " " (format::ms(times.min)) "–" (format::ms(times.max)) } }
}
