//! Machines side by side: how many times as fast each is as the first.

use super::page::title;
use crate::bench::format;
use crate::bench::group::{distinct, grouped};
use crate::bench::machines::{Machine, Row, Speed, mean, rows};
use crate::bench::record::{Ceilings, Rate, Results, Run, Time};
use crate::frame::times::{Interval, Statistics};
use crate::settings::Choice;
use maud::{Markup, html};

/// The machines, their rates, the mean speed of each method, and the speed of each run; none unless machines have runs in common.
pub fn section(results: &Results) -> Option<Markup> {
    let machines = Machine::all(results);
    let rows = rows(&machines);
    (!rows.is_empty()).then(|| {
        html! {
            (legend(&machines))
            (rates(&machines))
            (means(&machines, &rows))
            (all(&machines, &rows))
        }
    })
}

/// Letter of a machine; a number beyond Z.
fn letter(machine: usize) -> String {
    let letter = ('A'..='Z').nth(machine);
    letter.map_or_else(|| (machine + 1).to_string(), String::from)
}

/// Device, driver, host and program of each machine.
fn legend(machines: &[Machine<'_>]) -> Markup {
    html! {
        div.scroll { table {
            thead { tr {
                th scope="col" {} th scope="col" { "device" } th scope="col" { "driver" } th scope="col" { "processor" }
                th scope="col" { "program" }
            } }
            tbody { @for (number, machine) in machines.iter().enumerate() { tr {
                @let provenance = &machine.first().provenance;
                th scope="row" { (letter(number)) }
                @match &provenance.device {
                    Some(gpu) => { td.wide { (gpu.name) } td.wide { (gpu.driver) } }
                    None => { td { "none" } td {} }
                }
                td.wide { (provenance.host.cpu) ", " (provenance.host.cores) " cores" }
                td { "commit " code { (format::commit(&provenance.commit)) } ", " (format::day(provenance)) }
            } } }
        } }
    }
}

/// The rates of the devices that were measured.
fn rates(machines: &[Machine<'_>]) -> Markup {
    let measured = |machine: &Machine<'_>| machine.sessions.iter().find_map(|session| session.ceilings);
    let all: Vec<Option<Ceilings>> = machines.iter().map(measured).collect();
    let row = |name: &str, unit: &str, of: fn(&Ceilings) -> Option<Rate>| {
        html! { tr {
            th scope="row" { (name) }
            @for ceilings in &all { td.number { (ceilings.as_ref().and_then(of).map(|rate| format::rate(&rate, unit)).unwrap_or("–".into())) } }
        } }
    };
    html! { @if all.iter().flatten().count() > 1 {
        h3 { "Rates of the devices" }
        div.scroll { table {
            thead { tr { th scope="col" {} @for number in 0..machines.len() { th.number scope="col" { (letter(number)) } } } }
            tbody {
                (row("copy bandwidth", "B/s", |ceilings| Some(ceilings.copy)))
                (row("atomics, 32 bits", "/s", |ceilings| Some(ceilings.atomics)))
                (row("atomics, 64 bits", "/s", |ceilings| ceilings.wide_atomics))
                (row("fill rate", "px/s", |ceilings| Some(ceilings.fill)))
            }
        } }
    } }
}

/// Mean speed of each method over the runs that a machine and the first have in common.
fn means(machines: &[Machine<'_>], rows: &[Row<'_>]) -> Markup {
    let methods = distinct(rows.iter().map(|row| row.run.implementation.method.as_str()));
    html! {
        h3 { "Speed relative to machine A" }
        p {
            "How many times as fast as A: geometric mean over the runs in common, with the least and the greatest. Times are the work of a frame, "
            "which is GPU time or processor time, and wall time where the machines differ in that."
        }
        div.scroll { table {
            thead { tr {
                th scope="col" { "method" }
                @for number in 1..machines.len() { th.number scope="col" { (letter(number)) } th.number scope="col" { "runs" } }
            } }
            tbody { @for method in &methods { tr {
                th scope="row" { (method) }
                @for number in 1..machines.len() {
                    @let own = rows.iter().filter(|row| row.run.implementation.method == **method);
                    @match mean(own.filter_map(|row| row.speed(number))) {
                        Some((count, Interval { median, low, high })) => {
                            td.number { (speed(median, Some([low, high]))) } td.number { (count) }
                        }
                        None => { td.number { "–" } td.number { "0" } }
                    }
                }
            } } }
        } }
    }
}

/// Every run in common, experiment by experiment.
fn all(machines: &[Machine<'_>], rows: &[Row<'_>]) -> Markup {
    let experiments = distinct(rows.iter().map(|row| (&row.run.suite, row.run.experiment)));
    html! {
        p {
            "Each run: time of a frame in ms with its 95 % interval, and how many times as fast as A, from the least to the greatest quotient of "
            "both intervals. Fewer than six frames give no interval: their number stands in its place."
        }
        @for (suite, experiment) in &experiments {
            @let own: Vec<&Row> = rows.iter().filter(|row| (&row.run.suite, row.run.experiment) == (*suite, *experiment)).collect();
            details {
                summary { (suite) ", " (experiment.name()) ": " (own.len()) " runs" }
                div.scroll { (table(machines, &own)) }
            }
        }
    }
}

fn table(machines: &[Machine<'_>], rows: &[&Row<'_>]) -> Markup {
    let runs: Vec<&Run> = rows.iter().map(|row| row.run).collect();
    let groups = grouped(runs, |run| (&run.paper_item, run.view()));
    html! { table.passes {
        thead { tr {
            th.number scope="col" { "points" } th.number scope="col" { "overlap" } th scope="col" { "implementation" } th scope="col" { "options" }
            @for number in 0..machines.len() { th.number scope="col" { (letter(number)) ", ms" } }
            @for number in 1..machines.len() { th.number scope="col" { (letter(number)) " / A" } }
        } }
        @for ((item, view), runs) in &groups { tbody {
            tr.group { th colspan=(3 + 2 * machines.len()) scope="rowgroup" { (item) @if !item.is_empty() { ": " } (title(view)) } }
            @for row in rows.iter().filter(|row| runs.iter().any(|run| std::ptr::eq(*run, row.run))) { tr {
                td.number { (format::count(row.run.points)) }
                td.number { (row.run.overlap.map(|overlap| format::significant(overlap, 2)).unwrap_or_default()) }
                td { (row.run.implementation.label()) } td { (format::options_among(row.run, runs)) }
                @for number in 0..machines.len() {
                    td.number { @if let Some((time, of)) = row.time(number).zip(row.times[number]) { (spread(&time, of)) } @else { "–" } }
                }
                @for number in 1..machines.len() {
                    td.number { @if let Some(Speed { median, interval }) = row.speed(number) { (speed(median, interval)) } @else { "–" } }
                }
            } }
        } }
    } }
}

/// Median of a frame's time, with its 95 % interval, or the number of frames where these are too few for one.
fn spread(time: &Statistics, of: &Time) -> Markup {
    html! { (format::ms(time.median)) small { " " (format::ends_or_frames(time, of.frames)) } }
}

fn speed(median: f64, ends: Option<[f64; 2]>) -> Markup {
    html! {
        (format::baseline_ratio(median))
        @if let Some([low, high]) = ends { small { " " (format::significant(low, 2)) "–" (format::significant(high, 2)) } }
    }
}
