//! Passes as shares of the device's rates: copy bandwidth, fill rate, atomics.

use super::page::Page;
use super::plot::{Line, Plot, Scale, Style};
use crate::bench::format;
use crate::bench::group::{distinct, grouped};
use crate::bench::record::{Ceilings, Experiment, Pass, Rate, Run, Session, Shares};
use crate::settings::Choice;
use maud::{Markup, html};
use std::io;

/// Experiments of the scaling suite.
const EXPERIMENTS: [Experiment; 4] =
    [Experiment::ScalingPoints, Experiment::Filled, Experiment::ScalingSize, Experiment::ScalingOverlap];

/// The rates, what they mean, and the passes of the scaling runs as shares of them; empty if they were not measured.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Markup> {
    let Some(ceilings) = &session.ceilings else { return Ok(html! {}) };
    let scaling = |run: &&Run| EXPERIMENTS.contains(&run.experiment) && !run.work.is_empty();
    let runs: Vec<&Run> = session.runs.iter().filter(scaling).collect();
    let plot = plot(page, &runs, ceilings)?;
    let most = most_points(&runs);
    Ok(html! {
        h3 { "Passes as shares of the device's rates" }
        p {
            "Measured on this device by " @if ceilings.timestamps { "its timestamps" } @else { "the caller's wall time" }
            ", at the beginning of the session."
        }
        (rates(ceilings))
        p {
            "A pass moves at least what its declaration says: the streams and the splats of each surfel that it draws, and the pixels of each target, "
            "once. Divided by its time, that is a share of the copy bandwidth; pixels that it writes to images are a share of the fill rate, atomic "
            "minima a share of the atomics. Shares are lower bounds: splats are read once more by every tile that they cover, and samples by their "
            "neighbours. Two kinds of passes may move less: those over tiles (surface, nearest, and on the compute path visibility and attribute) skip "
            "hidden splats, those over pyramids (pull, push) skip samples without a point. A pass far below all of its shares is bound by arithmetic, "
            "latency or repeated reads. Above 100 %, caches serve it."
        }
        @if !most.is_empty() { (table(&most, ceilings)) }
        @if let Some(plot) = plot { div.plots { div { (plot) } } }
        @if runs.len() > most.len() {
            details { summary { "Shares of all " (runs.len()) " runs" } (table(&runs, ceilings)) }
        }
    })
}

/// Each rate with its interval, and how it was measured.
fn rates(ceilings: &Ceilings) -> Markup {
    let mib = |rate: &Rate| format!("{} MiB", format::mib(rate.memory));
    let row = |name: &str, rate: &Rate, unit: &str, how: String| {
        let ends = [rate.per_second.low, rate.per_second.high];
        let [low, high] = ends.map(|end| {
            format::rate(
                &Rate {
                    per_second: crate::frame::times::Interval { median: end, ..rate.per_second },
                    ..*rate
                },
                unit,
            )
        });
        html! { tr { th scope="row" { (name) } td.number { (format::rate(rate, unit)) } td.number { (low) "–" (high) } td.wide { (how) } } }
    };
    let atomics = |rate: &Rate, bits: u32| {
        format!(
            "atomicMin of {bits}-bit words by compute shaders, at pseudo-random addresses of {}; neighbours rarely share a word",
            mib(rate)
        )
    };
    let ceiling = &ceilings.copy;
    html! { div.scroll { table {
        thead { tr { th scope="col" { "rate" } th.number scope="col" { "median" } th.number scope="col" { "95 %" } th scope="col" { "measured by" } } }
        tbody {
            (row("copy bandwidth", ceiling, "B/s", format!("vkCmdCopyBuffer between two buffers, {} read and written", mib(ceiling))))
            (row("fill rate", &ceilings.fill, "px/s", format!("a triangle over the whole target of {}, four 32-bit floats a pixel", mib(&ceilings.fill))))
            (row("atomics, 32 bits", &ceilings.atomics, "/s", atomics(&ceilings.atomics, 32)))
            @if let Some(wide) = &ceilings.wide_atomics { (row("atomics, 64 bits", wide, "/s", atomics(wide, 64))) }
        }
    } } }
}

/// Of each implementation, the run with the most points at the size that most runs have.
fn most_points<'r>(runs: &[&'r Run]) -> Vec<&'r Run> {
    let points = runs.iter().copied().filter(|run| run.experiment == Experiment::ScalingPoints);
    let groups = grouped(points, |run| &run.implementation);
    groups.iter().filter_map(|(_, runs)| runs.iter().copied().max_by_key(|run| run.points)).collect()
}

fn table(runs: &[&Run], ceilings: &Ceilings) -> Markup {
    html! { div.scroll { table.passes {
        thead { tr {
            th scope="col" { "pass" } th.number scope="col" { "ms" } th.number scope="col" { "bytes" }
            th.number scope="col" { "of the copy bandwidth" } th.number scope="col" { "of the fill rate" } th.number scope="col" { "of the atomics" }
        } }
        @for run in runs { tbody {
            tr.group { th colspan="6" scope="rowgroup" { (title(run)) } }
            @for (pass, shares) in run.shares(ceilings) { (row(run, pass, shares)) }
        } }
    } } }
}

/// Implementation and what it renders.
fn title(run: &Run) -> String {
    let overlap = run.overlap.filter(|_| run.experiment == Experiment::ScalingOverlap);
    let overlap = overlap.map(|overlap| format!(", {} discs over a point", format::significant(overlap, 2)));
    let (points, size) = (format::count(run.points), format::size(run.size));
    let name = format::with_options(&run.implementation, &format::options(run));
    format!("{name}: {}, {points} points, {size} px{}", run.experiment.name(), overlap.unwrap_or_default())
}

fn row(run: &Run, pass: &Pass, shares: Option<Shares>) -> Markup {
    let share = |of: fn(&Shares) -> f64| {
        shares.as_ref().map(of).filter(|share| *share > 0.0).map_or("–".into(), format::percent)
    };
    let bytes = run.work.iter().find(|work| work.name == pass.name).map(|work| work.bytes);
    html! { tr {
        td { (pass.name) } td.number { (format::ms(pass.ms.median)) }
        td.number { @if let Some(bytes) = bytes { (format::mib(bytes)) " MiB" } @else { "–" } }
        td.number { (share(|shares| shares.copy)) } td.number { (share(|shares| shares.fill)) } td.number { (share(|shares| shares.atomics)) }
    } }
}

/// Share of the copy bandwidth by pass against points, of the implementation with the most numbers of points.
fn plot(page: &mut Page<'_>, runs: &[&Run], ceilings: &Ceilings) -> io::Result<Option<Markup>> {
    let points = runs.iter().copied().filter(|run| run.experiment == Experiment::ScalingPoints);
    let groups = grouped(points, |run| &run.implementation);
    let Some((implementation, mut own)) = groups.into_iter().rev().max_by_key(|(_, runs)| runs.len()) else {
        return Ok(None);
    };
    own.sort_by_key(|run| run.points);
    let names = distinct(own.iter().flat_map(|run| &run.work).map(|work| work.name.as_str()));
    let lines = names.iter().enumerate().filter_map(|(place, name)| {
        let point = |run: &&Run| {
            let (_, shares) = run.shares(ceilings).find(|(pass, _)| pass.name == *name)?;
            Some([run.points as f64, 100.0 * shares.filter(|shares| shares.copy > 0.0)?.copy])
        };
        let points: Vec<_> = own.iter().filter_map(point).collect();
        (!points.is_empty()).then(|| Line::new(*name, Style::nth(place), points))
    });
    let lines: Vec<_> = lines.collect();
    if lines.is_empty() {
        return Ok(None);
    }
    let label = implementation.label();
    let axes = [("points", Scale::Log), ("share of the copy bandwidth, %", Scale::Log)];
    let plot = Plot::of(format!("shares-{label}"), format!("Passes of {label}, at least"), axes, lines);
    page.plot(plot).map(Some)
}
