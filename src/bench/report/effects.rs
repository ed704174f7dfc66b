//! Effects: both sides of each, with the metrics that distinguish them. Those of the papers' figures, with what the papers say; then what we
//! claim beyond the papers.

use super::page::{Page, commands};
use super::papers;
use crate::bench::format;
use crate::bench::papers::effects::{self, Effect};
use crate::bench::papers::quotation::Quotation;
use crate::bench::papers::relation::{Relation, letter};
use crate::bench::papers::{run_label, runs};
use crate::bench::record::{Experiment, Run, Session};
use maud::{Markup, html};
use std::io;

/// One part per effect of the papers' figures.
pub fn of_papers(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let measured = measured(effects::of_papers(), session);
    Ok((!measured.is_empty()).then(|| {
        html! {
            p {
                "Each effect is shown by a scene in which one way to splat fails and another does not, by the presets as published. A result is as "
                "in the paper, or not, only where the paper says something: its words are quoted."
            }
            @for (effect, runs) in &measured { (one(page, session, effect, runs, true)) }
        }
    }))
}

/// Our claims: of the papers' effects, of our own ones, and of costs.
pub fn beyond(page: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let of_papers = measured(effects::of_papers().filter(|effect| !effect.claims.is_empty()), session);
    let own = measured(effects::beyond(), session);
    let costs = papers::costs_beyond(page, session);
    let any = !of_papers.is_empty() || !own.is_empty() || costs.is_some();
    Ok(any.then(|| {
        html! {
            p { "No paper says what follows: these are our claims, about published methods as well as about ours." }
            @if !of_papers.is_empty() {
                h3 { "Of the figures above" }
                @for (effect, runs) in &of_papers {
                    p { a href={ "#" (page.anchor(session, effect.name)) } { (effect.title) } }
                    (claims(effect, runs))
                }
            }
            @for (effect, runs) in &own { (one(page, session, effect, runs, false)) }
            @if let Some(costs) = &costs { (costs) }
        }
    }))
}

/// The effects with runs.
fn measured(
    effects: impl Iterator<Item = &'static Effect>,
    session: &Session,
) -> Vec<(&'static Effect, Vec<&Run>)> {
    let all = effects.map(|effect| (effect, runs(&session.runs, Experiment::Effects, effect.name)));
    all.filter(|(_, runs)| !runs.is_empty()).collect()
}

fn one(page: &Page<'_>, session: &Session, effect: &Effect, runs: &[&Run], of_paper: bool) -> Markup {
    let images = |run: &Run| session.images.get(run.images?);
    // Pictures of one scene have one truth, pictures of counts have none.
    let one_scene = runs.iter().all(|run| run.scene == runs[0].scene);
    let truth = runs.iter().filter(|run| one_scene && run.error.is_some()).find_map(|run| images(run));
    html! {
        h3 id=(page.anchor(session, effect.name)) { (effect.title) }
        p { (effect.description) }
        div.sides {
            @if let Some(images) = truth { (picture(&images.truth, "the exact picture", &[])) }
            @for (i, run) in runs.iter().enumerate() {
                @let name = format!("{}: {}", letter(i), run_label(run, runs));
                @let numbers = numbers(effect, run);
                @if let Some(images) = images(run) { (picture(&images.rendered, &name, &numbers)) }
                @else { figure { figcaption {
                    strong { (name) } (run.refused.as_deref().unwrap_or("no picture"))
                    @for number in &numbers { span { (number) } }
                } } }
            }
        }
        (commands(runs))
        @if of_paper { (expectations(effect, runs)) } @else { (claims(effect, runs)) }
    }
}

/// What the paper says, and whether it holds here.
fn expectations(effect: &Effect, runs: &[&Run]) -> Markup {
    html! {
        ul.expectations {
            @for expected in effect.expected {
                @if let Some((words, holds)) = decided(&expected.relation, runs) {
                    li.fault[!holds] {
                        @if holds { "As in the paper: " } @else { "Not as in the paper: " }
                        (words) ". " (quotation(&expected.says))
                    }
                }
            }
            (against(effect, runs))
        }
    }
}

fn claims(effect: &Effect, runs: &[&Run]) -> Markup {
    html! {
        ul.expectations {
            @for claim in effect.claims {
                @if let Some((words, holds)) = decided(claim, runs) {
                    li.fault[!holds] { @if holds { "Holds: " } @else { "Does not hold: " } (words) "." }
                }
            }
            @if effect.expected.is_empty() { (against(effect, runs)) }
        }
    }
}

/// A relation in words, and whether it holds; none if it was not measured.
fn decided(relation: &Relation, runs: &[&Run]) -> Option<(String, bool)> {
    Some((relation.words(runs)?, relation.holds(runs)?))
}

fn against(effect: &Effect, runs: &[&Run]) -> Markup {
    html! { @for words in effect.against(runs) { li.against { "Against it: " (words) "." } } }
}

/// The words of a paper, and where.
pub fn quotation(says: &Quotation) -> Markup {
    html! { q { (says.text) } " " span.source { "(" (says.source()) ")" } }
}

fn picture(png: &str, name: &str, numbers: &[String]) -> Markup {
    html! {
        figure {
            img src={ "data:image/png;base64," (png) } alt=(name);
            figcaption { strong { (name) } @for number in numbers { span { (number) } } }
        }
    }
}

/// Every metric.
fn numbers(effect: &Effect, run: &Run) -> Vec<String> {
    let number = |value| format::significant(value, 3);
    let all = effect.metrics.iter().map(|metric| (metric, metric.of(run)));
    let all = all
        .map(|(metric, value)| format!("{}: {}", metric.label, value.map_or("not measured".into(), number)));
    if run.refused.is_some() { Vec::new() } else { all.collect() }
}
