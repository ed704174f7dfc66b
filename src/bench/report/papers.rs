//! The papers' costs and tables beside the measured ones.

use super::page::Page;
use crate::bench::format;
use crate::bench::papers::claims::{self, Claim};
use crate::bench::papers::tables::{self, Table};
use crate::bench::papers::{published, ratio, row_result, runs};
use crate::bench::record::{Experiment, Run, Session};
use maud::{Markup, html};
use std::io;

/// A table of the costs, then one per published table.
pub fn content(_: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let costs = claims::ALL.iter().map(|claim| (claim, runs(&session.runs, Experiment::Claims, claim.name)));
    let costs: Vec<_> = costs.filter(|(_, runs)| runs.len() == 2).collect();
    let any = session.runs.iter().any(|run| run.experiment == Experiment::PaperTables);
    Ok((any || !costs.is_empty()).then(|| {
        html! {
            @if !costs.is_empty() { h3 { "Costs" } (table_of_costs(&costs)) }
            @if any { @for table in &tables::ALL { (one(table, session)) } }
        }
    }))
}

fn table_of_costs(costs: &[(&Claim, Vec<&Run>)]) -> Markup {
    html! {
        p {
            "Ratio of times of alternating frames: median, minimum and maximum; with the time and the RMSE of either side."
        }
        div.scroll { table {
            thead { tr {
                th scope="col" { "comparison" } th scope="col" { "published" } th.number scope="col" { "here" }
                th.number scope="col" { "ms" } th.number scope="col" { "RMSE" }
            } }
            tbody { @for (claim, runs) in costs { tr {
                td { (claim.title) } td.wide { (published(claim)) }
                td.number { (runs.last().map(|run| ratio(run)).unwrap_or_default()) }
                td.number { (pair(runs, Run::ms)) } td.number { (pair(runs, Run::rmse)) }
            } } }
        } }
    }
}

/// A number of the more expensive side against that of the cheaper one.
fn pair(runs: &[&Run], of: impl Fn(&Run) -> Option<f64>) -> String {
    let numbers: Option<Vec<_>> =
        runs.iter().rev().map(|run| Some(format::significant(of(run)?, 3))).collect();
    numbers.map(|numbers| numbers.join(" : ")).unwrap_or_default()
}

fn one(table: &Table, session: &Session) -> Markup {
    let runs = runs(&session.runs, Experiment::PaperTables, table.source);
    let columns = table.columns.len();
    html! {
        h3 { (table.source) @if !table.rows.is_empty() { ", " (table.unit.name()) } }
        p {
            @if !table.hardware.is_empty() { "There: " (table.hardware) ". Here: " (format::machine(session)) ". " }
            (table.note)
        }
        @if !table.rows.is_empty() { div.scroll { table.passes {
            thead { tr {
                th scope="col" { "model" } th.number scope="col" { "points" } th.number scope="col" { "size" }
                @for column in table.columns { th.number scope="col" { (column) } }
                th.number scope="col" { "here" } th scope="col" { "of" }
            } }
            tbody { @for row in table.rows { tr {
                @let [number, by] = row_result(row, table.unit, &runs);
                td { (row.model) } td.number { (format::count(row.points)) } td.number { (format::size(row.size)) }
                @for i in 0..columns { td.number { (row.published[i]) } }
                td.number { strong { (number) } } td { (by) }
            } } }
        } } }
    }
}
