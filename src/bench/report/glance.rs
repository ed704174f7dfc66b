//! Summary: the best setting for each budget of time and of error.

use super::page::{Page, titled};
use crate::bench::advice::{Advice, Column, Offer, within_error, within_time};
use crate::bench::record::{Run, RunSettings, Session};
use crate::bench::show;
use maud::{Markup, html};
use std::io;

/// Two tables: rows are budgets, columns are scenes.
pub fn content(_: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let Some(advice) = Advice::of(session) else { return Ok(None) };
    let Advice { columns, times, errors } = &advice;
    let time = |budget: f64| format!("{} ms", show::ms(budget));
    let error = |budget: f64| show::significant(budget, 2);
    Ok(Some(html! {
        p.lead {
            "Of the methods' runs, those on the Pareto front: none other is both faster and nearer to the truth. "
            @if multiples(session) { "× is a multiple of the CPU baseline, a plain renderer on the CPU. " }
            "Settings are named where they are not the method's own; the default method's are "
            (unbroken(&show::told(&RunSettings::defaults(), NAMED))) "."
        }
        h3 { "Least error within a budget of time" }
        (table("ms a frame", columns, times, time, |column, ms| within_time(&column.front, ms), true))
        h3 { "Least time within a budget of error" }
        (table("RMSE", columns, errors, error, |column, rmse| within_error(&column.front, rmse), false))
    }))
}

/// Low-pass filter, cut-off, widening, ε, culling and α; the shading is the same for all runs of a scene.
const NAMED: [bool; 7] = [true, true, true, true, true, true, false];

fn table<'c, 'a>(
    unit: &str,
    columns: &'c [Column<'a>],
    budgets: &[f64],
    name: impl Fn(f64) -> String,
    best: impl Fn(&'c Column<'a>, f64) -> Option<&'c Offer<'a>>,
    error_first: bool,
) -> Markup {
    let mut before: Vec<Option<&Offer>> = vec![None; columns.len()];
    html! {
        div.scroll { table.glance {
            thead { tr {
                th scope="col" { "budget, " (unit) }
                @for column in columns { th scope="col" { (titled(column.scene, column.size)) } }
            } }
            tbody { @for budget in budgets { tr {
                th scope="row" { "≤ " (name(*budget)) }
                @for (column, before) in columns.iter().zip(&mut before) {
                    @let found = best(column, *budget);
                    @let same = found.is_some() && std::mem::replace(before, found) == found;
                    @match found {
                        Some(offer) => { td.same[same] { (cell(offer, error_first)) } }
                        None => { td.none { "none fits" } }
                    }
                }
            } } }
        } }
    }
}

fn cell(offer: &Offer<'_>, error_first: bool) -> Markup {
    let Offer { run, ms, rmse } = offer;
    let multiple = run.time.as_ref().and_then(|time| time.baseline_ratio).map(show::baseline_ratio);
    let time =
        format!("{} ms", show::ms(*ms)) + &multiple.map(|text| format!(" ({text})")).unwrap_or_default();
    let error = format!("RMSE {}", show::significant(*rmse, 2));
    let [first, second] = if error_first { [error, time] } else { [time, error] };
    html! {
        strong { (first) } span { (second) }
        span { (show::count(run.points)) " points, " (run.implementation.label()) }
        @let settings = unusual(run);
        @if !settings.is_empty() { span { (settings) } }
    }
}

/// Whether there are times relative to the CPU baseline.
fn multiples(session: &Session) -> bool {
    session.runs.iter().any(|run| run.time.as_ref().is_some_and(|time| time.baseline_ratio.is_some()))
}

/// A list that breaks only between its entries.
fn unbroken(list: &str) -> String {
    list.replace(' ', "\u{a0}").replace(",\u{a0}", ", ")
}

/// The settings that differ from the method's defaults.
fn unusual(run: &Run) -> String {
    let (own, preset) =
        (show::settings(&run.settings), show::settings(&RunSettings::preset(&run.implementation.method)));
    show::told_of(run, std::array::from_fn(|i| NAMED[i] && own[i] != preset[i]))
}
