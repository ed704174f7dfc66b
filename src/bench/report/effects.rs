//! Effects that the papers' figures show: both sides of each, with the metrics that distinguish them.

use super::page::Page;
use crate::bench::format;
use crate::bench::papers::effects::{ALL, Effect, value};
use crate::bench::papers::{expectations, run_label, runs};
use crate::bench::record::{Experiment, Images, Run, Session};
use maud::{Markup, html};
use std::io;

/// One section per effect.
pub fn content(_: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    let measured = ALL.iter().map(|effect| (effect, runs(&session.runs, Experiment::Effects, effect.name)));
    let measured: Vec<_> = measured.filter(|(_, runs)| !runs.is_empty()).collect();
    Ok((!measured.is_empty()).then(|| {
        html! {
            p { "Each effect is shown by a built-in scene in which one way to splat fails and another does not." }
            @for (effect, runs) in &measured { (one(effect, runs, &session.images)) }
        }
    }))
}

fn one(effect: &Effect, runs: &[&Run], all_images: &[Images]) -> Markup {
    let images = |run: &Run| all_images.get(run.images?);
    // A picture of counts has no truth.
    let truth = runs.iter().filter(|run| run.error.is_some()).find_map(|run| images(run));
    html! {
        h3 { (effect.title) }
        p { (effect.description) " " span.source { "(" (effect.source) ")" } }
        div.sides {
            @if let Some(images) = truth { (picture(&images.truth, "the exact picture", &[])) }
            @for run in runs {
                @let name = run_label(run, runs);
                @let numbers = numbers(effect, run);
                @if let Some(images) = images(run) { (picture(&images.rendered, &name, &numbers)) }
                @else { figure { figcaption { strong { (name) } (run.refused.as_deref().unwrap_or("no picture")) } } }
            }
        }
        ul.expectations { @for (words, holds) in expectations(effect, runs) {
            li.fault[!holds] { @if holds { "As in the paper: " } @else { "Not as in the paper: " } (words) "." }
        } }
    }
}

fn picture(png: &str, name: &str, numbers: &[String]) -> Markup {
    html! {
        figure {
            img src={ "data:image/png;base64," (png) } alt=(name);
            figcaption { strong { (name) } @for number in numbers { span { (number) } } }
        }
    }
}

fn numbers(effect: &Effect, run: &Run) -> Vec<String> {
    let number = |(name, label): &(&str, &str)| {
        Some(format!("{label}: {}", format::significant(value(run, name)?, 3)))
    };
    effect.metrics.iter().filter_map(number).collect()
}
