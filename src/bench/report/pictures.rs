//! Images beside the truth and the perceived difference.

use super::page::{Page, titled};
use crate::bench::record::{Exhibit, Figure, Run, Session};
use crate::bench::show;
use maud::{Markup, html};
use std::io;

/// Truth, image and FLIP map in a row, with the run's metrics.
pub fn part(_: &mut Page<'_>, session: &Session) -> io::Result<Option<Markup>> {
    // Images of effects are shown with them.
    let elsewhere =
        |index| session.runs.iter().any(|run| run.figure == Figure::Effects && run.exhibit == Some(index));
    let exhibits: Vec<_> =
        session.exhibits.iter().enumerate().filter(|(index, _)| !elsewhere(*index)).collect();
    Ok((!exhibits.is_empty()).then(|| html! {
        p {
            "From left to right: the truth, the picture, and FLIP's map of the difference that a viewer sees who flips between them, from "
            "black (none) through red to pale yellow (most)."
        }
        @for &(index, exhibit) in &exhibits {
            figure.exhibit {
                div.row { @for (name, png) in pictures(exhibit) {
                    img src={ "data:image/png;base64," (png) } alt={ (exhibit.title) ": " (name) };
                } }
                figcaption { (words(exhibit, session.runs.iter().filter(|run| run.exhibit == Some(index)))) }
            }
        }
    }))
}

fn pictures(exhibit: &Exhibit) -> [(&'static str, &str); 3] {
    [("the truth", &exhibit.truth), ("the picture", &exhibit.picture), ("FLIP's map", &exhibit.map)]
}

/// The runs that the images belong to, or the title if there are none.
fn words<'r>(exhibit: &Exhibit, runs: impl Iterator<Item = &'r Run>) -> Markup {
    let runs: Vec<&Run> = runs.collect();
    html! {
        @for run in &runs { strong { (titled(&run.scene, run.size)) } ": " (caption(run)) ". " }
        @if runs.is_empty() { strong { (exhibit.title) } }
    }
}

fn caption(run: &Run) -> String {
    let mut words = vec![
        run.contender.label(),
        format!("{} points", show::count(run.points)),
        show::told_of(run, [true, true, true, false, false, false, false]),
    ];
    let metrics = [("rmse", "RMSE"), ("flip", "FLIP"), ("iou", "IoU")];
    let known = metrics.iter().filter_map(|(name, label)| Some((label, run.metric(name)?)));
    words.extend(known.map(|(label, value)| format!("{label} {}", show::significant(value, 3))));
    words.extend(run.ms().map(|ms| format!("{} ms", show::ms(ms))));
    words.join(", ")
}
