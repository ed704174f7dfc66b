//! Every figure and table of the papers: what measures it, or why nothing does.

use super::effects::quotation;
use super::page::Page;
use crate::bench::papers::inventory::{self, Coverage, Entry};
use crate::bench::papers::models;
use crate::bench::papers::quotation::Paper;
use crate::bench::record::{Experiment, Session};
use maud::{Markup, html};
use std::io;
use strum::VariantArray;

/// One table per paper.
pub fn content(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let ours = [Experiment::Effects, Experiment::Claims, Experiment::PaperTables];
    let any = session.runs.iter().any(|run| ours.contains(&run.experiment));
    Ok(any.then(|| {
        html! { @for paper in Paper::VARIANTS { h3 { (paper.name()) } (of(page, *paper, session)) } }
    }))
}

fn of(page: &Page<'_>, paper: Paper, session: &Session) -> Markup {
    html! {
        div.scroll { table.inventory {
            thead { tr {
                th scope="col" { "" } th scope="col" { "the paper" } th scope="col" { "measured by" }
            } }
            tbody { @for entry in inventory::of(paper) { tr {
                td { (entry.passage) } td.quotation { (quotation(&entry.says)) } td { (coverage(page, paper, entry, session)) }
            } } }
        } }
    }
}

fn coverage(page: &Page<'_>, paper: Paper, entry: &Entry, session: &Session) -> Markup {
    let items = entry.coverage.items();
    // A cost is shown with both of its runs.
    let ran = |item: &str| {
        let own = || session.runs.iter().filter(|run| run.paper_item == item);
        own().any(|run| run.experiment != Experiment::Claims) || own().count() == 2
    };
    html! {
        @for (i, item) in items.iter().enumerate() {
            @if i > 0 { ", " }
            @if ran(item) { a href={ "#" (page.anchor(session, item)) } { (item) } } @else { (item) ": not measured" }
        }
        @match entry.coverage {
            Coverage::None(why) => { "nothing: " (why) }
            Coverage::WithModels(item) if !ran(item) => { ". " (how_to_give(paper)) }
            _ => {}
        }
    }
}

/// The files of a paper's models.
fn how_to_give(paper: Paper) -> String {
    let own = models::ALL.iter().filter(|model| model.paper == paper);
    let files = own.map(|model| format!("{} ({})", model.files.join(" or "), model.origin.name()));
    format!("Give {} by --models", files.collect::<Vec<_>>().join("; "))
}
