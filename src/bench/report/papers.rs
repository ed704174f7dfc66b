//! The papers' costs and tables beside the measured ones.

use super::effects::quotation;
use super::page::Page;
use crate::bench::format;
use crate::bench::papers::costs::{self, Cost, Outcome};
use crate::bench::papers::tables::{self, Table};
use crate::bench::papers::{model_words, not_given, points, ratio, row_result, runs};
use crate::bench::record::{Experiment, Run, Session};
use maud::{Markup, html};
use std::io;

/// A table of the costs that the papers state, then one per published table.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let costs = measured(session, |cost| cost.says.is_some());
    let any = session.runs.iter().any(|run| run.experiment == Experiment::PaperTables);
    Ok((any || !costs.is_empty()).then(|| {
        html! {
            @if !costs.is_empty() { h3 { "Costs" } (table_of_costs(page, session, &costs)) }
            @if any { @for table in tables::all() { (one(page, session, table)) } }
        }
    }))
}

/// Costs that no paper states.
pub fn costs_beyond(page: &Page<'_>, session: &Session) -> Option<Markup> {
    let costs = measured(session, |cost| cost.says.is_none());
    (!costs.is_empty())
        .then(|| html! { h3 { "Costs that no paper states" } (table_of_costs(page, session, &costs)) })
}

fn measured(session: &Session, which: fn(&Cost) -> bool) -> Vec<(&'static Cost, Vec<&Run>)> {
    let costs = costs::ALL.iter().filter(|cost| which(cost));
    let costs = costs.map(|cost| (cost, runs(&session.runs, Experiment::Claims, cost.name)));
    costs.filter(|(_, runs)| runs.len() == 2).collect()
}

fn table_of_costs(page: &Page<'_>, session: &Session, costs: &[(&Cost, Vec<&Run>)]) -> Markup {
    let any = costs.iter().any(|(cost, _)| cost.says.is_some());
    let time = format::ratio_of(costs.iter().flat_map(|(_, runs)| runs.iter().copied()));
    html! {
        p {
            "Ratio of the work of alternating frames, " (time) ": the median with its 95 % interval. "
            @if any {
                "As in the paper is an interval that lies within what is published, not so one that lies outside; otherwise it is open. "
            }
            "Then the time and the RMSE of either side."
        }
        div.scroll { table {
            thead { tr {
                th scope="col" { "comparison" } th.number scope="col" { "here" }
                @if any { th.number scope="col" { "published" } th scope="col" { "outcome" } }
                th.number scope="col" { "ms" } th.number scope="col" { "RMSE" }
                th scope="col" { @if any { "the paper" } @else { "remark" } }
            } }
            tbody { @for (cost, runs) in costs { tr id=(page.anchor(session, cost.name)) {
                td.wide { (cost.title) }
                td.number { (runs.last().map(|run| ratio(run)).unwrap_or_default()) }
                @if let Some(says) = &cost.says {
                    td.number { (says.ratio) }
                    td { (outcome(runs.last().and_then(|run| cost.outcome(run)))) }
                }
                td.number { (pair(runs, Run::ms)) } td.number { (pair(runs, Run::rmse)) }
                td.quotation.wide {
                    @if let Some(says) = &cost.says { (quotation(&says.quotation)) }
                    @if !cost.note.is_empty() { div.source { (cost.note) } }
                }
            } } }
        } }
    }
}

fn outcome(outcome: Option<Outcome>) -> Markup {
    match outcome {
        Some(Outcome::AsPublished) => html! { span.outcome { "as in the paper" } },
        Some(Outcome::NotAsPublished) => html! { span.outcome.fault { "not as in the paper" } },
        Some(Outcome::Open) => html! { span.outcome.open { "open" } },
        None => html! { span.outcome.open { "not measured" } },
    }
}

/// A number of the more expensive side against that of the cheaper one.
fn pair(runs: &[&Run], of: impl Fn(&Run) -> Option<f64>) -> String {
    let numbers: Option<Vec<_>> =
        runs.iter().rev().map(|run| Some(format::significant(of(run)?, 3))).collect();
    numbers.map(|numbers| numbers.join(" : ")).unwrap_or_default()
}

fn one(page: &Page<'_>, session: &Session, table: &Table) -> Markup {
    let runs = runs(&session.runs, Experiment::PaperTables, &table.source());
    let (columns, replaced) = (table.columns.len(), not_given(table, &runs));
    html! {
        h3 id=(page.anchor(session, &table.source())) { (table.source()) ", " (table.unit.name()) }
        p {
            q { (table.caption.text) } " There: " (table.hardware) ". Here: " (format::machine(session)) ". " (table.note)
        }
        div.scroll { table.passes {
            thead { tr {
                th scope="col" { "model" } th.number scope="col" { "points" } th.number scope="col" { "size" }
                @for column in table.columns { th.number scope="col" { (column) } }
                th.number scope="col" { "here" } th scope="col" { "of" }
            } }
            tbody { @for row in table.rows { tr {
                @let [number, by] = row_result(table, row, &runs);
                td { (row.model) } td.number { (points(row)) } td.number { (format::size(row.size)) }
                @for i in 0..columns { td.number { (row.published[i]) } }
                td.number { strong { (number) } } td { (by) }
            } } }
        } }
        ul.expectations { @for (says, words, holds) in table.statements(&runs) {
            li.fault[!holds] {
                @if holds { "As in the paper: " } @else { "Not as in the paper: " } (words) ". " (quotation(&says))
            }
        } }
        @if !replaced.is_empty() && !runs.is_empty() {
            details {
                summary { "Models that a built-in scene of as many points replaces" }
                ul { @for model in replaced { li { (model_words(model)) } } }
            }
        }
    }
}
