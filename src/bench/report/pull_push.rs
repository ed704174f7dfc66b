//! Cost of pull–push against the number of points, pass by pass, and the number of points from which it is faster than
//! splats.

use super::page::Page;
use super::plot::{Line, Plot, Scale, Style};
use crate::bench::format;
use crate::bench::group::grouped;
use crate::bench::record::{Experiment, Implementation, Run, Session};
use crate::settings::methods::{Method, perspective_ewa, pull_push};
use maud::{Markup, html};
use std::io;

/// The methods shown.
const METHODS: [Method; 2] = [pull_push::METHOD, pull_push::PAPER];
/// The passes over pixels.
const OVER_PIXELS: [&str; 3] = ["pull", "copy", "push"];
/// The passes of pull–push.
const PASSES: [&str; 8] = ["project", "occupied", "fetch", "pull", "copy", "push", "filled", "shade"];

/// A plot per method, with its evaluation.
pub fn plots(page: &mut Page<'_>, session: &Session) -> io::Result<Vec<Markup>> {
    let timed = |run: &&Run| run.experiment == Experiment::ScalingPoints && run.ms().is_some();
    let runs = session.runs.iter().filter(timed);
    let mut plots = Vec::new();
    for ((scene, size), runs) in grouped(runs, |run| (&run.scene, run.size)) {
        for method in METHODS {
            let mut own = by(&runs, &method);
            own.sort_by_key(|run| run.points);
            let lines = lines(&own);
            if lines.is_empty() {
                continue;
            }
            let title = format!("Passes of {}: {}", method.name, format::scene(scene));
            let name = format!("passes-{}-{}", method.name, format::scene(scene));
            let axes = [("points", Scale::Log), ("time of a pass, ms", Scale::Log)];
            let filled = session.runs.iter().find(|run| {
                run.experiment == Experiment::Filled
                    && run.size == size
                    && run.implementation == own[0].implementation
            });
            let sentences =
                [against_filled(&own, filled), against_splats(&own, &by(&runs, &perspective_ewa::METHOD))];
            let plot = page.plot(Plot::of(name, title, axes, lines))?;
            plots.push(html! { div { (plot) p.caption { (sentences.join(" ")) } } });
        }
    }
    Ok(plots)
}

/// The runs of a method with its default settings.
fn by<'r>(runs: &[&'r Run], method: &Method) -> Vec<&'r Run> {
    let preset = Implementation { method: method.name.into(), variant: String::new() };
    runs.iter().copied().filter(|run| run.implementation == preset).collect()
}

fn lines(runs: &[&Run]) -> Vec<Line> {
    let line = |(i, name): (usize, &'static str)| {
        let point = |run: &&Run| Some([run.points as f64, pass(run, name)?]);
        let points: Vec<_> = runs.iter().filter_map(point).collect();
        (!points.is_empty()).then(|| Line::new(name, Style::nth(i), points))
    };
    PASSES.iter().copied().enumerate().filter_map(line).collect()
}

/// Median time of a pass, ms.
fn pass(run: &Run, name: &str) -> Option<f64> {
    let passes = &run.time.as_ref()?.passes;
    passes.iter().find(|pass| pass.name == name).map(|pass| pass.ms.median)
}

/// Time of the passes over pixels, ms, if there are any.
fn over_pixels(run: &Run) -> Option<f64> {
    let found: Vec<_> = OVER_PIXELS.iter().filter_map(|name| pass(run, name)).collect();
    (!found.is_empty()).then(|| found.iter().sum())
}

/// Time of the passes over pixels relative to their upper bound.
fn against_filled(runs: &[&Run], filled: Option<&Run>) -> String {
    let times = || runs.iter().filter_map(|run| over_pixels(run));
    let [least, most] = [times().fold(f64::INFINITY, f64::min), times().fold(0.0, f64::max)];
    if least > most {
        return String::new();
    }
    let range = format!("Pull and push take {} to {} ms", format::ms(least), format::ms(most));
    match filled.and_then(over_pixels).filter(|full| *full > 0.0) {
        Some(full) => format!(
            "{range}, at most {} times the {} ms that they take where every pixel shows a point.",
            format::significant(most / full, 2),
            format::ms(full)
        ),
        None => range + ".",
    }
}

/// The number of points from which it is faster than splats.
fn against_splats(runs: &[&Run], splats: &[&Run]) -> String {
    let faster = |run: &&Run| {
        let other = splats.iter().find(|other| other.points == run.points)?;
        Some((run.points, run.ms()? < other.ms()?))
    };
    let compared: Vec<_> = runs.iter().filter_map(faster).collect();
    let name = perspective_ewa::METHOD.name;
    let slower = compared.iter().rposition(|(_, faster)| !faster);
    match (compared.first(), slower.map(|last| compared.get(last + 1))) {
        (None, _) => String::new(),
        (Some((least, _)), None) => {
            format!(
                "It is faster than {name} at every number of points measured, from {}.",
                format::count(*least)
            )
        }
        (_, Some(Some((from, _)))) => {
            format!("It is faster than {name} from {} points on.", format::count(*from))
        }
        (_, Some(None)) => format!("It is not faster than {name} at the most points measured."),
    }
}
