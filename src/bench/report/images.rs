//! Images beside the truth and the perceived difference.

use super::page::{self, Page, title};
use crate::bench::format;
use crate::bench::images::MOST;
use crate::bench::record::{Experiment, Images, Run, Session};
use maud::{Markup, html};
use std::io;

/// Truth, image and FLIP map in a row, with the run's metrics.
pub fn content(_: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    // Images of effects are shown with them.
    let elsewhere = |index| {
        session.runs.iter().any(|run| run.experiment == Experiment::Effects && run.images == Some(index))
    };
    let all: Vec<_> = session.images.iter().enumerate().filter(|(index, _)| !elsewhere(*index)).collect();
    Ok((!all.is_empty()).then(|| html! {
        p {
            "From left to right: the truth, the picture, and FLIP's map of the perceived difference, from black (none) through red to pale "
            "yellow (most). Where the surface is unknown, the method's own float64 reference at 64 rays a pixel takes the place of the truth."
        }
        @for &(index, images) in &all {
            figure.images {
                div.row { @for (name, png) in pictures(images, is_own(session, index)) {
                    img src={ "data:image/png;base64," (png) } alt={ (images.title) ": " (name) };
                } }
                @let runs: Vec<_> = session.runs.iter().filter(|run| run.images == Some(index)).collect();
                figcaption { (words(images, &runs)) }
                (page::commands(&runs))
            }
        }
    }))
}

/// Whether the images of this index are of a run that has no truth.
fn is_own(session: &Session, index: usize) -> bool {
    session.runs.iter().any(|run| run.images == Some(index) && !run.has_truth())
}

fn pictures(images: &Images, is_own: bool) -> [(&'static str, &str); 3] {
    let truth = if is_own { "the method's own reference" } else { "the truth" };
    [(truth, &images.truth), ("the picture", &images.rendered), ("FLIP's map", &images.flip)]
}

/// The runs that the images belong to, or the title if there are none.
fn words(images: &Images, runs: &[&Run]) -> Markup {
    html! {
        @for run in runs { strong { (title(&run.view())) } ": " (caption(run)) ". " }
        @if runs.is_empty() { strong { (images.title) } }
    }
}

fn caption(run: &Run) -> String {
    let mut words = vec![
        format::with_options(&run.implementation, &format::options(run)),
        format!("{} points", format::count(run.points)),
    ];
    let metrics = [("rmse", "RMSE"), ("flip", "FLIP"), ("iou", "IoU")];
    let known = metrics.iter().filter_map(|(name, label)| Some((label, run.metric(name)?)));
    words.extend(known.map(|(label, value)| format!("{label} {}", format::significant(value, 3))));
    if !run.has_truth() {
        words.push("against its own reference".into());
    }
    words.extend(run.ms().map(|ms| format!("{} ms", format::ms(ms))));
    if run.size.iter().any(|side| *side > MOST) {
        words
            .push(format!("the middle {} of the picture", format::size(run.size.map(|side| side.min(MOST)))));
    }
    words.join(", ")
}
